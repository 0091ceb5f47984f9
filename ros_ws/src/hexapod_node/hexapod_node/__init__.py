"""What every rclpy node of the hexapod shares: parameters from a table, QoS, stamps, lock-step, spinning."""
