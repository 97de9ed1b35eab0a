"""Run all benchmarks and print their figures."""

from benchmarks import adaptive, coupled, impact, riser_only, tank

riser_only.report()
coupled.report()
adaptive.report()
impact.report()
tank.report()
