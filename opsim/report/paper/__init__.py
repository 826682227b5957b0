"""The folder that ``opsim motion judge --paper`` writes: tables as CSV, figures as SVG, and an index page."""
