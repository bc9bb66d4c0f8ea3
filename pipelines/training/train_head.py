#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Trains the head that says from which side an object is seen and which proportions it has.

Reads files of soslam-training-crops; writes the head, and prints what it is worth on models that it was not trained on.
"""
import argparse
import hashlib
import json
import sys

import h5py
import numpy as np
import torch
from torch import nn

BINS = 36  # of azimuth, about 0, 10 ... 350 degrees
CELLS = 49
SYMMETRIC = 0.15  # share of the largest difference below which a turned model counts as the same
RATIOS_WON = 0.75  # of the error of the group's mean: ratios of groups with more are not used
FEW_MODELS = 5  # left out: a group with fewer is not calibrated, and tells nothing. A guess
CORRELATION_DEG = 20.0  # as that of boxes; renders, whose clutter is another in each view, would say 10
FLOOR = 0.05  # probability that a picture tells nothing: wrong ids, labels, boxes. A guess: renders, which have none, would say 0.01
PLAIN = 10.0  # grey levels: differences that are smaller tell nothing


def text_of(attribute):
    return attribute.decode() if isinstance(attribute, bytes) else str(attribute)


def read_crops(path):
    file = h5py.File(path, "r")
    features = np.concatenate([file["features"][name][:] for name in sorted(file["features"])])
    return {
        "features": features.reshape(len(features) // 2, 2, -1, CELLS),  # plain and mirrored
        "quantum": float(file["features"].attrs["quantum"]),
        "facts": file["facts"][:],
        "model": file["model_of_crop"][:],
        "look": file["look_of_crop"][:],
        "group_of_model": file["group_of_model"][:],
        "turned": file["difference_from_turned"][:],
        "names": [line.split("\t") for line in text_of(file.attrs["models"]).strip().split("\n")],
        "probe": file["probe"][:],
        "attributes": dict(file.attrs),
    }


def is_left_out(name, always):
    """One model in five, by its name alone, and those that test sequences show: the same in every run."""
    full = "/".join([name[0], name[3]])
    return full in always or hashlib.sha256(full.encode()).digest()[0] % 5 == 0


def equivalent_turns(difference):
    """Turns (in bins) of a model that look the same: [0] of one with a front."""
    largest = max(difference.max(), PLAIN)
    return [turn for turn in range(BINS) if difference[turn] <= SYMMETRIC * largest or turn == 0]


def azimuth_targets(azimuth, turns):
    """Distributions over the bins, with the mass of each azimuth shared by the nearest two bins."""
    targets = np.zeros((len(azimuth), BINS), np.float32)
    place = np.mod(azimuth / (2 * np.pi) * BINS, BINS)
    low = np.floor(place).astype(int)
    part = place - low
    for i, equivalent in enumerate(turns):
        for turn in equivalent:
            targets[i, (low[i] + turn) % BINS] += (1 - part[i]) / len(equivalent)
            targets[i, (low[i] + 1 + turn) % BINS] += part[i] / len(equivalent)
    return targets


class Head(nn.Module):
    """1 x 1 convolution over the cells, two layers. Outputs: logarithms of the probabilities of azimuth; means of the log
    ratios, and logarithms of the standard deviations."""

    def __init__(self, channels, groups, narrow=32, hidden=160):
        super().__init__()
        self.narrow = nn.Linear(channels, narrow)
        self.hidden = nn.Linear(narrow * CELLS + 2 + groups, hidden)
        self.output = nn.Linear(hidden, BINS + 4)
        self.dropout = nn.Dropout(0.4)

    def forward(self, features, direction, group):
        x = torch.relu(self.narrow(features.transpose(1, 2)))  # [crops, cells, narrow]
        x = torch.cat([self.dropout(x.flatten(1)), direction, group], 1)
        x = self.output(self.dropout(torch.relu(self.hidden(x))))
        return torch.log_softmax(x[:, :BINS], 1), x[:, BINS:BINS + 2], x[:, BINS + 2:]


def batch_of(data, rows, flip, mean, scale):
    features = data["features"][rows, flip].astype(np.float32) * data["quantum"]
    features = torch.from_numpy((features - mean[:, None]) / scale[:, None])
    return features, torch.from_numpy(data["direction"][rows]), torch.from_numpy(data["one_hot"][rows])


def predict(head, data, rows, mean, scale):
    """Probabilities [rows, BINS], of the crop and its mirror image together; log ratios; their log sigmas."""
    head.eval()
    results = []
    with torch.no_grad():
        for begin in range(0, len(rows), 512):
            part = rows[begin:begin + 512]
            log_p, ratio, sigma = head(*batch_of(data, part, 0, mean, scale))
            log_m, ratio_m, sigma_m = head(*batch_of(data, part, 1, mean, scale))
            mirrored = torch.roll(torch.flip(log_m, [1]), 1, 1)
            results.append(((log_p.exp() + mirrored.exp()) / 2, (ratio + ratio_m) / 2, (sigma + sigma_m) / 2))
    return [torch.cat(parts).numpy() for parts in zip(*results)]


def errors_deg(p, azimuth, turns):
    """Angle between the most probable azimuth, between bins by a parabola, and the nearest right one."""
    best = p.argmax(1)
    rows = np.arange(len(p))
    left, middle, right = (np.log(p[rows, (best + k) % BINS] + 1e-9) for k in (-1, 0, 1))
    shift = np.clip(0.5 * (left - right) / np.minimum(left - 2 * middle + right, -1e-6), -0.5, 0.5)
    found = (best + shift) * 2 * np.pi / BINS
    errors = []
    for f, a, equivalent in zip(found, azimuth, turns):
        candidates = a + np.array(equivalent) * 2 * np.pi / BINS
        errors.append(np.degrees(np.abs((f - candidates + np.pi) % (2 * np.pi) - np.pi).min()))
    return np.array(errors)


def direction_weights(azimuth, elevation, correlation_deg):
    """DirectionWeights of soslam."""
    rays = np.stack([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)], 1)
    angle = np.degrees(np.arccos(np.clip(rays @ rays.T, -1, 1)))
    return 1 / np.exp(-0.5 * (angle / correlation_deg) ** 2).sum(1)


def fused_costs(p, azimuth, elevation, exponent, floor, correlation_deg):
    """Costs of the yaw's error (in bins) from several views."""
    weight = direction_weights(azimuth, elevation, correlation_deg)
    cost = -exponent * np.log((1 - floor) * p + floor / BINS)
    total = np.zeros(BINS)
    for c, a, w in zip(cost, azimuth, weight):
        place = np.mod(a / (2 * np.pi) * BINS - np.arange(BINS), BINS)
        low = place.astype(int)
        part = place - low
        total += w * ((1 - part) * c[low % BINS] + part * c[(low + 1) % BINS])
    return total


def joined(paths):
    """Crops of several files of one catalogue; looks have numbers of their own."""
    files = [read_crops(path) for path in paths]
    data = files[0]
    for path, file in zip(paths, files):
        for key in ("network_sha256", "layers", "models"):
            if text_of(file["attributes"][key]) != text_of(data["attributes"][key]):
                sys.exit(f"{path}: {key} is another than that of {paths[0]}; expected renders of one catalogue and network")
    for file in files[1:]:
        file["look"] += data["look"].max() + 1
        for key in ("features", "facts", "model", "look"):
            data[key] = np.concatenate([data[key], file[key]])
    return data


class LeftOut:
    """Views of models that were not trained on, in sets: of each look one, three and all of its views. What the head says
    of them chooses how far it is believed."""

    def __init__(self, head, paths, groups, always, mean, scale):
        data = joined(paths)
        left_out = np.array([is_left_out(name, always) for name in data["names"]])[data["model"]]
        rows = np.flatnonzero(left_out)
        group = data["group_of_model"][data["model"]]
        data["one_hot"] = np.eye(len(groups), dtype=np.float32)[group]
        data["direction"] = np.ascontiguousarray(data["facts"][:, 3:5])
        self.facts = data["facts"]
        self.turns = [equivalent_turns(difference) for difference in data["turned"]]
        self.p, self.ratio, self.log_sigma = (np.zeros((len(group), n)) for n in (BINS, 2, 2))
        self.p[rows], self.ratio[rows], self.log_sigma[rows] = predict(head, data, rows, mean, scale)
        self.sets = []  # (group, model, rows)
        for look in np.unique(data["look"][rows]):
            own = np.flatnonzero((data["look"] == look) & left_out)
            own = own[data["model"][own] == data["model"][own[0]]]
            for size in (1, 3, len(own)):
                self.sets.append((group[own[0]], data["model"][own[0]], own[:size]))
        self.calibrated = [g for g in range(len(groups)) if len({s[1] for s in self.sets if s[0] == g}) >= FEW_MODELS]

    def costs(self, rows, exponent, floor, correlation_deg):
        return fused_costs(self.p[rows], self.facts[rows, 0], self.facts[rows, 3], exponent, floor, correlation_deg)

    def yaw_gain(self, sets, exponent, floor=FLOOR, correlation_deg=CORRELATION_DEG):
        """Logarithm of the probability of the right yaw, over chance (nats), of each set."""
        gains = []
        for _, model, rows in sets:
            cost = self.costs(rows, exponent, floor, correlation_deg)
            log_p = -cost - np.logaddexp.reduce(-cost)
            right = np.logaddexp.reduce(log_p[[turn % BINS for turn in self.turns[model]]])
            gains.append(right - np.log(len(self.turns[model]) / BINS))
        return np.array(gains)

    def ratio_gain(self, sets, ratio_mean, ratio_sigma, scale, shared=1.0):
        """Logarithm of the density of the right log ratios (nats), over that of the group's models, the error, and that of
        the group's mean, of each set. `scale` of the head's standard deviations; `shared` part of the variance of a view's
        error that all views of a body have in common."""
        gains, errors, priors = [], [], []
        for group, _, rows in sets:
            truth = self.facts[rows[0], 1:3] - ratio_mean[group]
            mean, information = likelihood_of_ratios(self.ratio[rows], self.log_sigma[rows] + np.log(scale), ratio_sigma[group])
            telling = (information > 0).all(1)  # the others are left out, as by soslam
            weight = direction_weights(self.facts[rows[telling], 0], self.facts[rows[telling], 3], CORRELATION_DEG)[:, None]
            total = (weight * information[telling]).sum(0)
            fused = (weight * information[telling] * mean[telling]).sum(0) / np.maximum(total, 1e-9)
            precision = total / (1 + shared * (weight.sum() - 1)) if telling.any() else total
            of_prior = 1 / ratio_sigma[group] ** 2
            posterior = precision * fused / (precision + of_prior)
            gains.append(0.5 * (np.log((precision + of_prior) / of_prior) - (precision + of_prior) * (truth - posterior) ** 2
                                + of_prior * truth ** 2).sum())
            errors.append(np.abs(truth - posterior))
            priors.append(np.abs(truth))
        return np.array(gains), np.array(errors), np.array(priors)


def likelihood_of_ratios(ratio, log_sigma, prior_sigma):
    """Mean and information (one over the variance) of the likelihood: what the head says, which starts from the group's
    models, over what these alone would say. Both relative to the group's mean. No information where it is no surer."""
    of_head = np.exp(-2 * log_sigma)
    information = np.maximum(of_head - 1 / prior_sigma ** 2, 0)
    return of_head * ratio / np.maximum(information, 1e-9), information


def over_models(sets, gains):
    """Mean and standard error over models: they are what varies."""
    models = np.array([model for _, model, _ in sets])
    means = np.array([gains[models == m].mean() for m in np.unique(models)])
    return means.mean(), means.std(ddof=1) / np.sqrt(len(means)) if len(means) > 1 else np.inf, len(means)


def calibrate_yaw(left_out, groups):
    """Exponent of each group, at most 1, under which looks at models left out are most probable. Groups that gain less than
    twice the standard error have exponent 0."""
    chairs = [s for s in left_out.sets if groups[s[0]]["name"] in ("chair", "couch")]
    for correlation in (10.0, 20.0, 40.0):
        best = max((left_out.yaw_gain(chairs, e, FLOOR, correlation).mean(), e) for e in (0.5, 0.7, 0.85, 1.0, 1.2, 1.5, 2.0))
        print(f"chairs and couches, directions {correlation:.0f} deg: gain {best[0]:.2f} nats over chance with exponent {best[1]}")
    gains = ", ".join(f"{floor} {left_out.yaw_gain(chairs, 1.0, floor).mean():.2f}" for floor in (0.005, 0.01, 0.02, 0.05, 0.1))
    print(f"chairs and couches, exponent 1.0, gain by floor: {gains}")
    exponents = []
    reliability = []  # (probability said of the most probable side, whether it is right)
    for g, name in enumerate(groups):
        own = [s for s in left_out.sets if s[0] == g]
        if g not in left_out.calibrated:
            exponents.append(0.0)
            print(f"{name['name']:10} too few models left out: not used")
            continue
        choices = [(left_out.yaw_gain(own, e), e) for e in (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.85, 1.0)]
        gains, exponent = max(choices, key=lambda choice: choice[0].mean())
        gain, error, models = over_models(own, gains)
        used = gain > 2 * error
        exponents.append(float(exponent) if used else 0.0)
        wrong = []
        for _, model, rows in own:
            cost = left_out.costs(rows, exponent, FLOOR, CORRELATION_DEG)
            off = min(abs((cost.argmin() - t + BINS / 2) % BINS - BINS / 2) for t in left_out.turns[model]) * 10
            if len(rows) >= 5:
                wrong.append(off)
            if used and len(left_out.turns[model]) == 1:
                said = np.exp(-cost - np.logaddexp.reduce(-cost))
                reliability.append((said[np.arange(cost.argmin() - 3, cost.argmin() + 4) % BINS].sum(), off <= 30))
        wrong = np.array(wrong)
        print(f"{name['name']:10} {models:3} models {len(own):4} sets: gain {gain:.2f} +- {error:.2f}, exponent {exponent}{'' if used else ', not used'}; "
              f"all views of a look: median error {np.median(wrong):.0f} deg, below 30: {(wrong <= 30).mean():.2f}")
    said, right = np.array(reliability).T
    print("things with one front, within 30 deg of the most probable yaw: said, found, sets")
    edges = (0.0, 0.5, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99, 1.01)
    for low, high in zip(edges, edges[1:]):
        own = (said >= low) & (said < high)
        if own.any():
            print(f"  {said[own].mean():.3f} {right[own].mean():.3f} {own.sum():5}")
    return exponents


def calibrate_ratios(left_out, groups, ratio_mean, ratio_sigma):
    """Scale, at least 1, of the head's standard deviations for each group under which the ratios of models left out are most
    probable, 0 where ratios do not win. Views of one body are taken to share their errors: renders would not say so."""
    chosen = np.zeros(len(groups))
    of_shares = {0.0: 0.0, 0.5: 0.0, 1.0: 0.0}
    for g in left_out.calibrated:
        own = [s for s in left_out.sets if s[0] == g]
        gain_of = lambda scale, shared=1.0: left_out.ratio_gain(own, ratio_mean, ratio_sigma, scale, shared)[0].mean()
        scale = max((1.0, 1.2, 1.5, 2.0, 3.0), key=gain_of)
        for shared in of_shares:
            of_shares[shared] += gain_of(scale, shared)
        gains, errors, priors = left_out.ratio_gain(own, ratio_mean, ratio_sigma, scale)
        gain, error, _ = over_models(own, gains)
        share = errors.mean(0) / priors.mean(0)
        used = gain > 2 * error and share.mean() < RATIOS_WON
        chosen[g] = scale if used else 0.0
        print(f"{groups[g]['name']:10} log ratios: gain {gain:.2f} +- {error:.2f}, scale {scale}; error over that of the group's mean {share[0]:.2f} {share[1]:.2f}"
              f"{'' if used else ', not used'}")
    print("sum of these gains where a part of the variance is shared by all views of a body: "
          + ", ".join(f"{share} {gain:.2f}" for share, gain in of_shares.items()))
    return chosen


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--crops", nargs="+", required=True, help="files of soslam-training-crops, of one catalogue")
    parser.add_argument("--calibration", nargs="+", required=True, help="such files with several views of each look")
    parser.add_argument("--groups", required=True, help="groups.json")
    parser.add_argument("--output", required=True, help="head.h5 to write")
    parser.add_argument("--epochs", type=int, default=36)
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    torch.manual_seed(arguments.seed)
    random = np.random.default_rng(arguments.seed)
    settings = json.load(open(arguments.groups, encoding="utf8"))
    groups, always = settings["groups"], set(settings["left_out"])

    data = joined(arguments.crops)
    names, group_of_model, turned = (data[key] for key in ("names", "group_of_model", "turned"))
    group = group_of_model[data["model"]]
    data["one_hot"] = np.eye(len(groups), dtype=np.float32)[group]
    data["direction"] = np.ascontiguousarray(data["facts"][:, 3:5])
    turns_of_model = [equivalent_turns(difference) for difference in turned]
    turns = [turns_of_model[model] for model in data["model"]]
    azimuth = data["facts"][:, 0]
    targets = torch.from_numpy(azimuth_targets(azimuth, turns))
    mirrored_targets = torch.roll(torch.flip(targets, [1]), 1, 1)
    left_out = np.array([is_left_out(name, always) for name in names])[data["model"]]
    train, test = np.flatnonzero(~left_out), np.flatnonzero(left_out)
    print(f"{len(train)} crops of models to train on, {len(test)} of models left out")

    sample = data["features"][random.choice(train, min(len(train), 3000), replace=False), 0].astype(np.float32) * data["quantum"]
    mean, scale = sample.mean((0, 2)), sample.std((0, 2)) + 1e-3
    spread = sample.mean(2).std(0) + 1e-3  # of the crops' mean features
    # Ratios are learned relative to the mean of the group's models.
    log_ratios = data["facts"][:, 1:3]
    of_models = np.array([log_ratios[data["model"] == m].mean(0) if (data["model"] == m).any() else [np.nan] * 2 for m in range(len(names))])
    known = np.array([not is_left_out(name, always) for name in names])
    ratio_mean = np.array([np.nanmean(of_models[(group_of_model == g) & known], 0) for g in range(len(groups))])
    relative = torch.from_numpy((log_ratios - ratio_mean[group]).astype(np.float32))
    ratio_sigma = np.array([relative[train][group[train] == g].numpy().std(0) for g in range(len(groups))])

    head = Head(data["features"].shape[2], len(groups))
    optimiser = torch.optim.AdamW(head.parameters(), lr=2e-3, weight_decay=0.02)
    steps = arguments.epochs * (len(train) // 128)
    schedule = torch.optim.lr_scheduler.OneCycleLR(optimiser, 2e-3, total_steps=steps)
    step = 0
    for epoch in range(arguments.epochs):
        head.train()
        order = random.permutation(train)
        total = 0.0
        for begin in range(0, len(order) - 127, 128):
            rows = order[begin:begin + 128]
            flip = int(random.integers(2))
            log_p, ratio, log_sigma = head(*batch_of(data, rows, flip, mean, scale))
            target = (mirrored_targets if flip else targets)[rows]
            residual = (ratio - relative[rows]) / log_sigma.exp()
            of_ratios = (0.5 * residual.clamp(-4, 4) ** 2 + log_sigma).sum(1)
            loss = -(target * log_p).sum(1).mean() + 0.3 * of_ratios.mean()
            optimiser.zero_grad()
            loss.backward()
            optimiser.step()
            if step < steps:
                schedule.step()
            step += 1
            total += loss.item()
        if epoch % 5 == 4 or epoch == arguments.epochs - 1:
            print(f"epoch {epoch + 1}: loss {total / (len(order) // 128):.3f}", flush=True)

    p, ratio, log_sigma = predict(head, data, test, mean, scale)
    error = errors_deg(p, azimuth[test], [turns[i] for i in test])
    print("models left out, single crops: mean, median error (deg), share below 30; log ratios: error, that of the group's mean")
    for g, name in enumerate(groups):
        own = group[test] == g
        if not own.any():
            continue
        found = np.abs(ratio[own] - relative[test][own].numpy()).mean(0)
        prior = np.abs(relative[test][own].numpy()).mean(0)
        print(f"{name['name']:10} {len(set(data['model'][test][own])):3} models {own.sum():5} crops  {error[own].mean():5.1f} {np.median(error[own]):5.1f} "
              f"{(error[own] < 30).mean():.2f}   {found[0]:.3f} {found[1]:.3f}  {prior[0]:.3f} {prior[1]:.3f}")
    pt, _, _ = predict(head, data, train[:2000], mean, scale)
    et = errors_deg(pt, azimuth[train[:2000]], [turns[i] for i in train[:2000]])
    print(f"trained models: {et.mean():.1f} {np.median(et):.1f} {(et < 30).mean():.2f}")

    looks = LeftOut(head, arguments.calibration, groups, always, mean, scale)
    exponents = calibrate_yaw(looks, groups)
    ratio_scale = calibrate_ratios(looks, groups, ratio_mean, ratio_sigma)
    weights = {name: value.detach().numpy() for name, value in head.named_parameters()}
    # The scaling of the features is part of the first layer.
    arrays = {"narrow/weights": weights["narrow.weight"] / scale,
              "narrow/bias": weights["narrow.bias"] - weights["narrow.weight"] @ (mean / scale),
              "ratio_mean": ratio_mean, "ratio_sigma": ratio_sigma, "probe": data["probe"],
              "feature_mean": mean, "feature_scale": spread}
    for name in ("hidden", "output"):
        arrays[f"{name}/weights"], arrays[f"{name}/bias"] = weights[f"{name}.weight"], weights[f"{name}.bias"]
    with h5py.File(arguments.output, "w") as file:
        for name, array in arrays.items():  # as soslam's own files
            file.create_dataset(name, data=array.astype(np.float32), chunks=array.shape, shuffle=True, compression="gzip")
        for key in ("side_px", "rgb_0_1"):
            file.attrs[key] = float(data["attributes"][key])
        file.attrs["floor"], file.attrs["direction_correlation_deg"] = FLOOR, CORRELATION_DEG
        of_groups = [{"name": g["name"], "labels": g["labels"], "exponent": e, "ratio_sigma_scale": float(r)} for g, e, r in zip(groups, exponents, ratio_scale)]
        header = {"kind": "head", "schema_version": [1, 0], "software": "train_head.py", "settings": {}, "inputs": []}
        for key, text in (("artefact", json.dumps(header)), ("groups", json.dumps(of_groups)),
                          ("network_sha256", text_of(data["attributes"]["network_sha256"])), ("layers", text_of(data["attributes"]["layers"]))):
            file.attrs[key] = np.bytes_(text.encode())


if __name__ == "__main__":
    sys.exit(main())
