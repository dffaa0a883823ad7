"""The configuration of Ray in these tests, and in the programs that they start."""

import os
import secrets

os.environ |= {
    # Without an address, Ray joins the latest cluster on this machine, which may belong to another
    # test.
    "RAY_ADDRESS": "local",
    # Without a token, Ray would write one into the user's home directory.
    "RAY_AUTH_MODE": "token",
    "RAY_AUTH_TOKEN": secrets.token_hex(32),
    "RAY_USAGE_STATS_ENABLED": "0",
}
