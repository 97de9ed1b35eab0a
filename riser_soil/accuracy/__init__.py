"""Accuracy of a scene's answers: headline quantities, knobs that vary a scene, extrapolation, the study of a scene."""
