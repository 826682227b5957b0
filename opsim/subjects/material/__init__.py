"""What waits, comes together and comes apart: stores, bills of material, splits, cards."""
