"""How much of the style the content still tells: a discriminator Dis, trained afresh on what a
trained ZS-MSTM makes of speech and text (thesis 6.5.4)."""

import numpy as np
import torch

from ...reference import run as reference
from .. import losses, tasks
from ..batched import small, zs_mstm
from ..trainer import BEST, CHECKPOINT


def evidence(run, data_folder, steps=400, seed=1):
    """Dis' error on the development split as a share of the style's variance: 1 says that nothing
    of the style can be told from the content."""
    configuration = torch.load(run / CHECKPOINT, map_location="cpu")["configuration"]
    task_class = tasks.of(configuration["kind"])
    task = task_class(configuration, task_class.open_data(data_folder), torch.device("cpu"))
    task.module.weights().load_state_dict(torch.load(run / BEST, map_location="cpu"))
    task.eval()
    rng = np.random.default_rng(seed)
    (content, style), (dev_content, dev_style) = (_codes(task, items, rng)
                                                  for items in (task.items, task.dev_items()))
    mean, deviation = style.mean(0), style.std(0).clamp_min(1e-3)
    style, dev_style = ((x - mean) / deviation for x in (style, dev_style))
    torch.manual_seed(seed)
    dis = reference.new(task.dis_network).float()
    optimiser = torch.optim.Adam(dis.parameters(), lr=1e-3, weight_decay=1e-4)
    best = float("inf")
    for step in range(steps):
        chosen = torch.from_numpy(rng.integers(len(content), size=64))
        loss = losses.squares(small.discriminate(dis, content[chosen]), style[chosen])
        optimiser.zero_grad()
        loss.backward()
        optimiser.step()
        if step % 20 == 19:
            with torch.no_grad():
                told = small.discriminate(dis, dev_content)
            best = min(best, float(losses.squares(told, dev_style) / dev_style.var()))
    return {"error": best, "segments": len(content)}


def _codes(task, items, rng, batch=16):
    """h_content, pooled to one row, and h_style of the speakers' other utterances."""
    contents, styles = [], []
    for at in range(0, len(items), batch):
        segments, clips = task.batch(items[at:at + batch], rng)
        with torch.no_grad():
            h = zs_mstm.content(task.module.encoders, segments["speech"], segments["text"])
            contents.append(h.mean(1, keepdim=True))
            styles.append(zs_mstm.style_of_clips(task.module, clips))
    return torch.cat(contents), torch.cat(styles)
