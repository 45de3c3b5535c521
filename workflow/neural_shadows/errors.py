"""The one exception for what the user can mend, and full disks."""

import errno


class InputError(Exception):
    """Something that was given is wrong: a file, a key, a value.

    The message is one readable line that names the file, key or value and says what
    to do about it. Whoever catches it prints the message without a traceback.
    """


def is_full_disk(error: BaseException) -> bool:
    """Whether a file could not be written for lack of room, or of a user's quota."""
    return isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT)
