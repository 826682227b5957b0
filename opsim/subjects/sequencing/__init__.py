"""Which job is next, and what changing over costs: dispatching rules, queues, set-ups."""
