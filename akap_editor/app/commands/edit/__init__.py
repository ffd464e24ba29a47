"""Commands of the Edit menu that arrange the selected pins."""
