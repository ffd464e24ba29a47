"""Methods side by side over the same drags: runs them, measures them and reports."""
