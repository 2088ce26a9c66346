"""Memos: spoken notes."""
