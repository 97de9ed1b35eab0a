"""Bodies that lines hang on, and the joints between lines and bodies."""
