"""Shapes and time: spheres, flattening, warps, elastic alignment, pauses (Chen, Park & Srivastava sec. 3, 4.1)."""
