"""The sections of a configuration: a model of each, and what follows from several of them."""
