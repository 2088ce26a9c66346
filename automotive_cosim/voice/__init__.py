"""What is heard in a moving car: how loud it is, and what a recogniser and the driver make of words in it."""
