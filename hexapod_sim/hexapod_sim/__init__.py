"""MuJoCo model of the hexapod, its sensors and the line-following task, as a node and as a library."""
