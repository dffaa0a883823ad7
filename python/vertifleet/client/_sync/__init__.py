# Written from ../_async/__init__.py by python/tools/client_sync.py: do not edit.
"""The client that waits for every answer."""
