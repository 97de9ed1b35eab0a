"""What everything else is written against: arrays, compiled kernels, the contract of parts, the system they make up."""
