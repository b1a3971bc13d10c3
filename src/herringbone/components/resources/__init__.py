"""The resource files of components: their grammar, and the tables that they become."""
