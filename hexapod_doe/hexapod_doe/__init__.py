"""Designed experiments over sensor sets: plans, campaigns, bags, regression and report."""
