"""An example of a plug-in for opsim: what to write and where to register it (see pyproject.toml beside src)."""
