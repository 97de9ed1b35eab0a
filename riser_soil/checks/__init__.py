"""What is told of a scene before it is solved: `check`, plausibility warnings, the size and whether it fits."""
