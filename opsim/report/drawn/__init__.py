"""The figures of a report drawn by matplotlib, for papers: from the same data as plotly draws them on the page.

Needs the extra ``matplotlib``. Of plotly's language as much is understood as ``opsim.report`` speaks; anything else
raises ValueError, so that no file shows less than the page.
"""
