"""Scenes: objects, lights, cameras and ray queries."""
