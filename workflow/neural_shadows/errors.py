"""The one exception for what the user can mend."""


class InputError(Exception):
    """Something that was given is wrong: a file, a key, a value.

    The message is one readable line that names the file, key or value and says what
    to do about it. Whoever catches it prints the message without a traceback.
    """
