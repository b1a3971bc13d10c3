"""What a component declares: variables, units, tables, laws, roles."""
