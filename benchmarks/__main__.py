"""Run all benchmarks and print their figures."""

import argparse

from benchmarks import adaptive, condensed, coupled, impact, length, plastic, riser_only, storm, tank, twins, waves

argparse.ArgumentParser(prog="python -m benchmarks", description=__doc__).parse_args()
riser_only.report()
length.report()
twins.report()
coupled.report()
condensed.report()
plastic.report()
adaptive.report()
impact.report()
tank.report()
storm.report()
waves.report()
