"""What a system consists of: parts, connections, nested systems, and its network."""
