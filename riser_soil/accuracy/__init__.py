"""Accuracy of a scene's answers: key results, settings that vary a scene, extrapolation, the study of a scene."""
