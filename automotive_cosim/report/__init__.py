"""Pages, tables and animations that show the results of a run."""
