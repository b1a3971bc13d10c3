"""The neutral format of modal housings: what it is, reader, writer, what is refused."""
