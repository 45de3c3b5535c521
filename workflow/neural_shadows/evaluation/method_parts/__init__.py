"""What computes soft shadows; methods import it when they answer."""
