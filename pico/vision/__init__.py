"""What cameras see: markers, poses with their uncertainty, calibration. Pure functions over pictures and numbers.

The same code reads pictures of real cameras and of the twin's. Millimetres; radians inside, degrees in results.
Camera frames are OpenCV's: x right, y down, z into the scene; the center of the first pixel is (0, 0).
"""
