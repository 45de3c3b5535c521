"""Networks of one object: a ray on its sphere to the depth of its shadow."""
