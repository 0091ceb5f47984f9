"""Launch files, configuration and the composed worker of the hexapod graph."""
