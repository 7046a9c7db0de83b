"""From parts put down by the arm to light in a fibre: an iris, then a camera, then the fibre, each begun in the dark.

For each seed a bench is made anew: a laser, two mirrors with tip and tilt, an iris, splitters to a power meter and to a
lens with a camera, a fibre coupler. The arm puts its parts down, each off by what the catalog says of its seat, in a
world that drifts; nobody measures where they came to stand, and no start is drawn by its power. Then the goals of the
lab are sought: light behind the iris, the spot on the camera, light in the fibre. Counted is every measurement of all
stages. Light is `found` where the fibre in truth takes at least 90 % of what it could, by the traced bench as it is.

    python benchmarks/stages.py [--seeds 40]
"""
