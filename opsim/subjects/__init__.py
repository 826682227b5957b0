"""Subjects of the floor, a folder each: what may be said of it, what is wrong or risky, numbers, steps, the sheet."""
