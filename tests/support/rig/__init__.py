"""The test rig, as several tests take it."""
