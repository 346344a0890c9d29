"""Shapes of the parameters of PyTorch's layers: key -> shape."""


def linear(key, rows, cols):
    return {key + ".weight": (rows, cols), key + ".bias": (rows,)}


def norm(key, d):
    return {key + ".weight": (d,), key + ".bias": (d,)}


def conv1d(key, channels, columns, kernel):
    return {key + ".weight": (channels, columns, kernel), key + ".bias": (channels,)}


def attention(key, d):
    """nn.MultiheadAttention."""
    return {key + ".in_proj_weight": (3 * d, d), key + ".in_proj_bias": (3 * d,),
            **linear(key + ".out_proj", d, d)}


def lstm(key, columns, hidden, layers=1, directions=("",)):
    """nn.LSTM: gates i, f, g, o below one another."""
    shapes = {}
    for k in range(layers):
        for direction in directions:
            end = f"l{k}{direction}"
            shapes |= {
                f"{key}.weight_ih_{end}": (4 * hidden, hidden * len(directions) if k else columns),
                f"{key}.weight_hh_{end}": (4 * hidden, hidden),
                f"{key}.bias_ih_{end}": (4 * hidden,),
                f"{key}.bias_hh_{end}": (4 * hidden,),
            }
    return shapes


def bilstm(key, columns, hidden):
    """nn.LSTM of one layer that runs both ways; its rows are 2 * hidden wide."""
    return lstm(key, columns, hidden, directions=("", "_reverse"))
