"""The sheet Drive: the backlash of the whole drive worked in formulas, beside the catalogue's stiffness."""
