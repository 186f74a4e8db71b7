// SPDX-License-Identifier: AGPL-3.0-or-later
// The list of jobs, the newest first.
import { byId, count, duration, el, keyed, plural, say } from "./text.js";

let most = 30;

function make(job) {
	return el("tr", {},
		el("td", {},
			el("a", { class: "job-name", href: `#job-${job.id}` }),
			el("span", { class: "job-under" }, el("span"), el("span", { class: "bar", "aria-hidden": "true" }, el("span", { class: "settled" })))),
		el("td"), el("td", { class: "end" }));
}

function update(row, job, chosen) {
	const [name, frames, left] = row.cells;
	const [link, under] = name.children;
	say(link, job.name);
	link.title = job.name;
	say(under.children[0], `#${job.id} ${job.stage}`);
	under.children[1].firstChild.style.width = `${100 * job.strips_done / job.strips}%`;
	under.children[1].hidden = job.stage === "done";
	say(frames, `${count(job.frames_done)}/${count(job.frames)}`);
	say(left, job.stage === "running" && job.eta !== null ? duration(job.eta) : "–");
	chosen ? row.setAttribute("aria-current", "true") : row.removeAttribute("aria-current");
}

export function drawJobs(model) {
	const all = [...model.jobs.values()].sort((a, b) => b.id - a.id);
	const shown = all.slice(0, most);
	if (model.chosen && !shown.includes(model.chosen))
		shown.push(model.chosen);
	keyed(byId("job-rows"), shown, job => job.id, make, (row, job) => update(row, job, job === model.chosen));
	byId("more-jobs").hidden = all.length <= most;
	byId("more-jobs").onclick = () => {
		most += 200;
		drawJobs(model);
	};
	say(byId("jobs-title"), all.length ? plural(all.length, "job") : "Jobs");
	byId("jobs").hidden = !all.length;
}
