"""The client for asyncio. python/tools/client_sync.py writes the synchronous one from these files."""
