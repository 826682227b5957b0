"""Which station stands where: flows between places, changes of the layout, first proposals, and the best simulated."""
