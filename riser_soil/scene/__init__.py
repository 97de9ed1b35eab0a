"""The scene language: models, reader, checks, resolved scene and JSON schema."""
