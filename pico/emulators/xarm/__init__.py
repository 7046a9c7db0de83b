"""The control box of a UFACTORY xArm7 with its gripper, written from the vendor's published register specification.

`server.XArmEmulator` is what a test or `--emulate` starts; `world.World` is what stands behind it. The pages meant are
those of `private_tcp_protocol/` in the vendor's public documentation (p05 to p20); what they leave open is said where
it is decided.
"""
