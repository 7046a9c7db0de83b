"""The UFACTORY xArm7 and its gripper, through the vendor's own library (extra `xarm`)."""
