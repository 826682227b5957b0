"""What a run assumes, topic by topic, and what somebody should know before he believes it."""
