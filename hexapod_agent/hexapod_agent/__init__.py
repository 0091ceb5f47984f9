"""DDPG agent that observes a chosen set of sensors, its Gymnasium environment and its training."""
