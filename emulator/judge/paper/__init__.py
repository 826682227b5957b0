"""The tables of Chen, Park & Srivastava made anew on other recordings, our scheme beside theirs."""
