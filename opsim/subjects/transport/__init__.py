"""Places and the ways between them: walking, transporters, conveyors."""
