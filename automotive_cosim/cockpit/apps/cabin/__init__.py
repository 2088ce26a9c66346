"""Cabin: who is aboard, how warm it will be for those who stay, and what is switched for them."""
