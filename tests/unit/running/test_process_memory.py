import mmap

from neural_shadows.running.process_memory import held_bytes, peak_bytes

MIB = 2**20


def test_memory_that_was_given_back_is_in_the_peak_alone():
    begin = held_bytes()
    # Of the system itself: an array may lie in memory that was given back by another before.
    with mmap.mmap(-1, 64 * MIB) as memory:
        memory.write(bytes(64 * MIB))
        held = held_bytes()
    assert held - begin > 60 * MIB
    assert held_bytes() < held - 60 * MIB
    assert peak_bytes() > held - 2 * MIB  # the kernel counts in batches of pages
