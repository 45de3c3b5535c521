"""Debian's `chromium`, with WebGL2 in software."""

import shutil

CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome")
# Without its sandbox, which containers do not allow; the pages are our own. Chromium no longer
# falls back to software by itself, and then has no WebGL at all.
ARGUMENTS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
