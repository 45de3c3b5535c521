"""The same configuration gives the same bytes, however and wherever it is run.

What may differ, and by how much, is stated where it is tested: the last test.
"""

from dataclasses import replace


def test_clean_run_on_one_core_in_a_path_with_a_space(undisturbed):
    """The undisturbed run has two cores, and another path."""
    checkout = replace(undisturbed.another(finished=False), cores=1)
    assert " " in str(checkout.folder) and " " not in str(undisturbed.checkout.folder)
    undisturbed.finish(checkout)
    undisturbed.same_as(checkout)
