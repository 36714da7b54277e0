"""The line engine: a model tabulated along lines through the space of its inputs.

    line_direction      which way the lines of a row run
    line_points         where they pass: scores across the direction
    line_crossings      where tabulated curves cross an output
    line_tables         the model along the lines, and what keeps lines from a row
    line_smoothness     steps, bends and dips between the positions of a table
    shape_rules         expectations over one shape of distribution, and the variable that polynomials of it are in
    term_rules          expectations over one input, or over correlated inputs together
    line_surrogate      a sum over the inputs that stands for the model, and its exact moments
    surrogate_law       the exact distribution of that sum
    line_control        surrogate and model on the same lines: where their difference is sharper than the model alone
    line_drawing        lines through rows, with the surrogates that help
    line_fronts         where all lines cross outputs, and the probabilities that follow
    line_quantiles      outputs and the probabilities above them
    line_moments        mean, sd, skewness and kurtosis
    line_shares         shares of variance; correlated_line_shares where inputs are correlated
    surrogate_shares    those of the surrogate, and how the model departs from it
    line_precision      how many lines a row needs
    line_spread         the spread of one model by lines
    line_statistics     the statistics of many rows by lines
    lot_inputs          inputs that a lot draws once, those that each part draws, and how both act together
    lot_variance        how the variance divides into that within lots and that between them
    line_lots           the share of lots that fail, by lines through the inputs of lots and of parts
    entangled_lots      the same where lots and parts act together otherwise than by a sum or a product
    lot_statistics      what lots and parts have of the spread of many rows

Every input is a function of a standard normal *score*. A *position* on a line is a score as well. *Rows alike* have
the same model and the same shapes of distribution; arrays hold them all: (inputs, rows), (levels, rows), or with all
lines side by side (k, rows × lines). A *level* is one probability or one output that is asked for.
"""
