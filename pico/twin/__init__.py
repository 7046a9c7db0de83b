"""The digital twin: the bench as a MuJoCo scene, and pictures of it that need no OpenGL."""
