"""The figures of evidence.json as tables of Markdown."""


def markdown(figures):
    parts = []
    for network, conditions in figures["transfer"].items():
        for condition, found in conditions.items():
            parts.append(f"### {network}, {condition} styles, {found['pairs']} pairs\n\n"
                         + _transfer(found))
    if figures["probe"]:
        parts.append("### What the content tells of the style\n\n" + _table(
            ("run", "error of Dis, share of the style's variance"),
            [(name, f"{found['error']:.3f}") for name, found in figures["probe"].items()]))
    for name, found in figures["face"].items():
        parts.append(f"### {name}, {found['windows']} sequences, "
                     f"{100 * found['covered']:.0f} % of their frames\n\n" + _face(found))
    return "\n".join(parts)


def _transfer(found):
    rivals = _rivals(found["rivals"])
    near = found["nearness"]
    nearness = _table(("distance of a point, units, to", "mean"), [
        ("the source's motion", f"{near['source']:.1f}"),
        ("another utterance of the target speaker", f"{near['target']:.1f}"),
        ("the truth of the transfer", f"{near['truth']:.1f}"),
        ("content preservation, eq. 7.5", f"{near['content']:.1f} %")])
    dist = _table(("Dist_avg(prediction, target)", "pooled", "mean of pairs",
                   "pooled, target = exact truth", "the gesturer's, pooled"),
                  [(name, *(f"{x[key]:.1f} %" for key in ("pooled", "mean", "exact", "gesturer")))
                   for name, x in found["dist"].items()])
    timing = _table(("speed of the wrists, correlation with the truth", "PCC"),
                    [(name, f"{x:.2f}") for name, x in found["timing"].items()])
    style = _table(("habit of the target speakers", "PCC of the model", "PCC of the gesturer"),
                   [(name, f"{x['model']:.2f}", f"{x['truth']:.2f}")
                    for name, x in found["style"].items()])
    tables = [rivals, nearness, dist, timing, style]
    if found.get("expressions"):
        tables.append(_table(("part of the face", "PCC with the truth", "with other speech",
                              "deviation, share of the truth's"),
                             [(name, *(f"{x:.2f}" for x in values))
                              for name, values in found["expressions"].items()]))
    return "\n".join(tables)


def _rivals(rivals):
    head = ["against the truth of the transfer", "RMSE, units", "PCC",
            "mean distance of a point, units"]
    rows = [[name, f"{x['rmse']:.1f}", _number(x["pcc"]), f"{x['per_point']:.1f}"]
            for name, x in rivals.items()]
    if "face_rmse" in rivals["model"]:
        head += ["RMSE of landmarks, units", "PCC"]
        for row, x in zip(rows, rivals.values()):
            row += [f"{x['face_rmse']:.2f}", _number(x["face_pcc"])]
    return _table(head, rows)


def _face(found):
    rows = [(x["name"], _number(x["rmse"], 3), _number(x["pcc"]), _number(x["ahr_intensity"], 1),
             _number(x["nahr"], 1)) for x in found["channels"]]
    return _table(("channel", "RMSE", "PCC", "AHR", "NAHR"), rows)


def _number(x, digits=2):
    return "-" if x is None else f"{x:.{digits}f}"


def _table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines) + "\n"
