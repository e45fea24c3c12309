"""The command `sprag`."""

from __future__ import annotations

import signal
import sys

from . import _core


def main() -> None:
    """Runs the command with the words of the command line."""
    # The program waits for Ctrl-C itself.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_core.main(["sprag", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
