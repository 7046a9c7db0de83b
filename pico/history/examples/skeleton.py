"""The lab that `pico init` writes: small, right as it stands, with comments that say what to change."""

from __future__ import annotations

_LAB = """\
# The bench: what is bolted down, what the arm may move, where parts are stored.
# Millimeters and degrees; origin at the front-left corner, x right, y away from you, yaw counter-clockwise.
# `pico validate` says what is wrong in this file, `pico render --view top` shows it.
apiVersion: pico/v1
kind: Lab
metadata:
  name: NAME
table:
  size: [1200, 900]
  beam_height: 70           # height of the optical axis above the table
slots:                      # storage: fingers need 90 mm from one to the next for parts of 60 x 60 mm
  storage/a1: {x: 380, y: 260}
  storage/a2: {x: 470, y: 260}
  storage/a3: {x: 560, y: 260}
robots:
  arm1:
    model: xarm7            # reaches 0.10 to 0.67 m from its base
    mount: {x: 480, y: 760, yaw: -90}   # yaw: where it faces; -90 is the front edge
policy:
  arming:                   # who lets lasers above class 2 emit: `pico laser arm`, docs/how-to/laser-safety.md
    waived: [kinematic, physics, emulated]   # what is simulated or emulated emits nothing; hardware is never waived
inventory:                  # every part that this bench owns; `pico catalog list` names the types
  laser:
    type: hene_laser
    pose: {x: 200, y: 420, yaw: 0}      # a fixed pose: bolted, never moved by the arm
  camera:
    type: beam_camera
    pose: {x: 760, y: 420, yaw: 0}
  lens:
    type: plano_convex_100
    marker: 1               # the number of the marker on its top
    home: storage/a2        # where it goes when a state does not name it
"""

_STATE = """\
# The state: what stands where, and what is set. This is what commits version; one tunable a line.
# Edit it, then `pico plan` and `pico apply`; or move things and `pico capture`.
apiVersion: pico/v1
kind: LabState
metadata: {lab: NAME}
components:
  camera:
    exposure: 5             # ms
  laser:
    emission: false
    shutter: closed
  lens:
    slot: storage/a2        # or a pose: x, y, yaw, one a line
"""

SKELETON = {"lab.yaml": _LAB, "state/table.yaml": _STATE}
"""Files by path in the lab's folder; NAME stands for the name of the lab."""
