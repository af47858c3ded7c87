"""`python -m lightproof.cli`: the command line where the script is not on the path."""

import sys

from lightproof.cli import main

sys.exit(main())
