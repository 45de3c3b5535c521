"""The claims of the texts, judged by measurements.

kinds         the kinds of claims, a file each: settings, files and comparisons
claim_kinds   the interface of these files
write_claims  the stage: reads files, judges each claim
inputs        the files and parameters of that stage
gates         the tests in their order, of which the first that fails is the verdict
comparison    one comparison of a claim, and the verdict of all comparisons together
measured      the measured values, by method, budget and seed
views, losses, frames   the units of paired differences: viewpoints, trainings, frames of soft shadows
learning      the trend over learning curves, and the extrapolation that they license
screen_networks, setting_types   shared by several kinds
"""
