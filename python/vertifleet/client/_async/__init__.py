"""The client for asyncio. The one without it is made of these files by python/tools/client_sync.py."""
