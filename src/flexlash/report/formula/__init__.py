"""Formulas that carry their own value, and the data sheets behind them."""
