"""Every posture of a shift in time order, and what is folded over them."""
