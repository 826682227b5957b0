"""Workers: who they are, what they can do, who goes where; rotations and teams."""
