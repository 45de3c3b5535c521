"""Verdicts of claims and their meanings."""

NOT_COMPARABLE = "not comparable"
NOT_LEARNED = "not learned"
VACUOUS = "vacuous"
TOO_SMALL = "undecided (scale)"
UNDECIDED = "undecided"
SUPPORTED = "supported"
CONTRADICTED = "contradicted"

# In the order of the tests: a claim gets the first verdict that applies.
MEANINGS = {
    NOT_COMPARABLE: "what was measured is not what the claim is about: another mesh than the "
    "thesis's, or times of another class of device.",
    NOT_LEARNED: "a network of the claim is not better than the null predictors (no shadow, in every "
    "metric; for a screen-space network the best of no shadow, the hard map and its own base, in "
    "squared error on validation frames), or diverged, so that it says nothing of networks that have "
    "learned.",
    VACUOUS: "supported, and a null predictor (no shadow, all dark, the light's map as it is, a "
    "network's base) passes the same test in the networks' place; where others are to beat a network, "
    "only below a thirtieth of its text's samples.",
    TOO_SMALL: "too few training samples, seeds, views, frames or scenes for what is claimed, and no "
    "learning curves license an extrapolation to the samples of its text; or networks of less than a "
    "thirtieth of these, which say nothing of more.",
    UNDECIDED: "the intervals do not separate the claim from its contrary.",
    SUPPORTED: "the 95 % interval lies on the claim's side in each of its comparisons; of numbers "
    "without one the number itself, of printed ones each difference beyond the margin.",
    CONTRADICTED: "one comparison or more lies on the other side, at a level of 5 % for all of "
    "the claim's comparisons together (Holm); of printed numbers, beyond the margin.",
}
VERDICTS = tuple(MEANINGS)

# For a reader who has not met the words.
IN_SHORT = {
    NOT_COMPARABLE: "it is about another mesh or device than ours.",
    NOT_LEARNED: "our network has learned too little to tell.",
    VACUOUS: "true here, and so it is with something untrained in the network's place.",
    TOO_SMALL: "we have too few samples, seeds or scenes to tell.",
    UNDECIDED: "not true in every comparison, and clearly untrue in none.",
    SUPPORTED: "true in each comparison.",
    CONTRADICTED: "clearly untrue in one comparison or more.",
}

# For those who cannot tell the colours apart.
SYMBOLS = {
    NOT_COMPARABLE: "≠",
    NOT_LEARNED: "○",
    VACUOUS: "∅",
    TOO_SMALL: "…",
    UNDECIDED: "?",
    SUPPORTED: "✓",
    CONTRADICTED: "✗",
}


def css_class(verdict: str) -> str:
    """The page's class of a verdict: `undecided-scale`."""
    return verdict.replace(" (", "-").replace(" ", "-").strip(")")
