"""The thesis's claims, judged by what this run or the thesis itself has measured.

write_claims  the stage: reads files, judges each claim, writes CSV and Markdown
gates         the tests in their order, of which the first that fails is the verdict
comparison    one comparison of a claim, and what all comparisons say together
better, lower_loss, frame_time, violations, printed, soft, ratio, proportional   the comparisons of
                 each kind of claim
learning      the trend over learning curves, and the extrapolation that they license
measured      what claims are tested on, by method, budget and seed
"""
