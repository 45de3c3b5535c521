"""Files that are whole or not at all: written, read with a check, unpacked, downloaded."""
