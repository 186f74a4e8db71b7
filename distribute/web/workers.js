// SPDX-License-Identifier: AGPL-3.0-or-later
// Who renders, on what, how fast; those in trouble first.
import { byId, duration, el, keyed, moment, plural, rate, say } from "./text.js";

let most = 40;
/** A worker that has not been heard of for so many seconds is worth a word. */
const quiet = 12;

/** "fall 12, rows 33 to 64": where a strip is. */
export function place(job, strip) {
	if (!job)
		return "";
	const frame = job.first + Math.floor(strip / job.strips_per_frame) * job.step;
	const row = strip % job.strips_per_frame * job.strip_rows;
	const rows = job.strips_per_frame > 1 ? `rows ${row + 1} to ${Math.min(row + job.strip_rows, job.height)}` : "";
	return [job.animation ? `frame ${frame}` : "", rows].filter(Boolean).join(", ") || "the picture";
}

const age = worker => Date.now() / 1000 - worker.seen;

function state(worker) {
	if (worker.aside)
		return `set aside: ${worker.aside}`;
	if ((worker.silent ?? 0) + age(worker) > quiet && worker.busy > 0 && worker.silent > quiet)
		return `silent for ${duration(worker.silent + age(worker))}`;
	if (worker.rests > age(worker))
		return `rests after failures, for ${duration(worker.rests - age(worker))}`;
	return worker.draining ? "leaves after this" : worker.busy ? "works" : "waits";
}

const labels = [null, "busy", null, "strips", "a minute", "since", null];

function make() {
	return el("tr", { role: "row" }, ...labels.map((label, i) => el("td", { role: "cell", "data-label": label, class: [1, 3, 4].includes(i) ? "end" : i ? null : "worker-name" })));
}

function update(row, worker, model) {
	const cells = row.cells;
	if (!cells[0].childElementCount)
		cells[0].append(el("span"), el("small"));
	say(cells[0].firstChild, worker.name);
	say(cells[0].lastChild, worker.from);
	say(cells[1], `${worker.busy ?? 0}/${worker.slots}`);
	const on = (worker.strips ?? []).map(s => {
		const job = model.jobs.get(s.job);
		return `${job?.name ?? "job"} #${s.job}, ${place(job, s.strip)}, for ${duration(s.seconds + age(worker))}`;
	});
	const shown = on.slice(0, 3).join("\n") + (on.length > 3 ? `\nand ${on.length - 3} more` : "");
	if (cells[2].dataset.text !== shown) {
		cells[2].dataset.text = shown;
		cells[2].replaceChildren(...shown.split("\n").filter(Boolean).map(line => el("div", {}, line)));
	}
	say(cells[3], worker.done ?? 0);
	const minutes = (model.now() - worker.since) / 60;
	say(cells[4], worker.done && minutes > 0 ? rate(worker.done / minutes) : "–");
	say(cells[5], moment(worker.since));
	const text = state(worker);
	say(cells[6], text);
	cells[6].className = worker.aside || text.startsWith("silent") ? "trouble" : text === "works" ? "" : "quiet";
}

export function drawWorkers(model) {
	const order = w => (w.aside ? 0 : w.busy ? 1 : 2);
	const all = [...model.workers.values()].sort((a, b) => order(a) - order(b) || a.name.localeCompare(b.name, undefined, { numeric: true }) || (a.id < b.id ? -1 : 1));
	keyed(byId("worker-rows"), all.slice(0, most), w => w.id, make, (row, w) => update(row, w, model));
	byId("more-workers").hidden = all.length <= most;
	byId("more-workers").onclick = () => {
		most += 200;
		drawWorkers(model);
	};
	byId("no-workers").hidden = all.length > 0;
	document.querySelector("#workers table").hidden = !all.length;
	say(byId("workers-title"), all.length ? plural(all.length, "worker") : "Workers");
}
