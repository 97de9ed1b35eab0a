"""What the numbers cost: run by `make bench`; ratios measured in one run, as machines are noisy."""
