"""All that a session is, without a window: document, history, tools, recording."""
