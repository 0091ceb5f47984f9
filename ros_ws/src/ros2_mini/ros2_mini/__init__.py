"""A small `ros2` command for machines that have rclpy from PyPI and no ROS 2 install."""
