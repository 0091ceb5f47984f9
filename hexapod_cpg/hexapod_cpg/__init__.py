"""Central pattern generator: coupled Hopf oscillators and their mapping to joint angles."""
