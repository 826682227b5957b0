"""A finished run to be looked at: who was where and did what, posture by posture, and the page that shows it."""
