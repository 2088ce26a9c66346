"""Evaluations for others: one file to publish, its check, and a page of many."""
