"""The scene language: models, reader, checks across parts, echo and JSON schema."""
