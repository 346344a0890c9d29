"""Many agents, cold starts, memory, deadlines beside other programs: python3 -m bench.scale."""
