"""Who waited for what when a run ended, and whether those who wait could ever have moved again."""
