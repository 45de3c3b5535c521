"""The same configuration gives the same bytes on the same machine, however it is run.

Threads change nothing (tests/unit/test_training.py). Another processor or a GPU adds the products
of its layers in another order: between machines no equality of bytes is claimed.
"""

from dataclasses import replace


def test_clean_run_on_one_core_in_a_path_with_a_space(undisturbed):
    """The undisturbed run has two cores, and another path."""
    checkout = replace(undisturbed.another(finished=False), cores=1)
    assert " " in str(checkout.folder) and " " not in str(undisturbed.checkout.folder)
    undisturbed.finish(checkout)
    undisturbed.same_as(checkout)
