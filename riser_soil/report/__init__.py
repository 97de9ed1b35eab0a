"""Reports of runs, from the files in their folders."""
