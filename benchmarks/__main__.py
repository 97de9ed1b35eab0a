"""Run all benchmarks and print their figures."""

from benchmarks import adaptive, coupled, impact, riser_only

riser_only.report()
coupled.report()
adaptive.report()
impact.report()
