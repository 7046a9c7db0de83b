"""Lets the tests import what stands beside them and beside those of execution."""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "execution")]
