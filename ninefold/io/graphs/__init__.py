"""Pose graphs: what a robot's odometry and its loop closures say of where it was.

`g2o` reads such a file and writes it without some of its lines; `closures` judges the loop closures.
"""
