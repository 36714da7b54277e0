"""Tables of materials, ISO tolerances and catalogue stiffness, as CSV files beside this module."""
