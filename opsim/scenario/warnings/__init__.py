"""What may go wrong in a scenario that is right: said by ``opsim check`` as a warning, never refused."""
