"""What a network answers on frames of the user's own."""
