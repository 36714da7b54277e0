"""What every stage shares: columns, units, rules, records of a variant, findings and their words."""
