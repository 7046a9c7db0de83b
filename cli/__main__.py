"""`python -m pico_cli` is `pico`."""

import sys

from .main import main

sys.exit(main())
