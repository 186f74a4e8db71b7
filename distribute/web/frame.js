// SPDX-License-Identifier: AGPL-3.0-or-later
// One frame, large.
import { byId, el, plural, say } from "./text.js";
import { blank, fill } from "./frames.js";
import { place } from "./workers.js";

export class Frame {
	constructor(model, previews) {
		Object.assign(this, { model, previews, dialog: byId("frame"), index: 0 });
		byId("frame-picture").append(...blank("div").childNodes);
		byId("frame-before").onclick = () => this.step(-1);
		byId("frame-after").onclick = () => this.step(1);
		addEventListener("keydown", e => { // not the dialog's: a button that has just been disabled takes the focus with it
			const by = { ArrowLeft: -1, ArrowRight: 1 }[e.key];
			if (by && this.dialog.open)
				this.step(by);
		});
		this.dialog.addEventListener("click", e => {
			if (e.target === this.dialog) // beside it
				this.dialog.close();
		});
	}

	show(index) {
		this.index = index;
		this.job = this.model.chosen.id;
		this.dialog.showModal();
		this.draw();
	}

	step(by) {
		const next = this.index + by;
		if (next >= 0 && next < this.model.chosen.frames)
			this.index = next;
		this.draw();
	}

	draw() {
		const { model, index, dialog } = this, job = model.chosen;
		if (!dialog.open || !job || !model.strips.length)
			return;
		if (job.id !== this.job || index >= job.frames)
			return dialog.close();
		const tile = byId("frame-picture");
		const shape = job.width / job.height, room = Math.min(960, innerWidth - 70);
		const width = Math.floor(Math.min(room, 0.62 * innerHeight * shape + 9));
		Object.assign(tile.style, { width: `${width}px`, height: `${Math.floor((width - 11) / shape + 2)}px` });
		fill(tile, index, model, this.previews, 1024);
		const done = model.settled[index], all = job.strips_per_frame;
		say(byId("frame-title"), job.animation ? `Frame ${model.number(index)} of ${job.name}` : job.name);
		say(byId("frame-text"), done === all ? "Done." : `${done} of ${plural(all, "strip")} done.`);
		const here = [];
		for (const worker of model.workers.values())
			for (const s of worker.strips ?? [])
				if (s.job === job.id && Math.floor(s.strip / all) === index)
					here.push(`${place(job, s.strip)} on ${worker.name}`);
		byId("frame-out").replaceChildren(...here.map(text => el("li", {}, text)));
		byId("frame-before").disabled = index === 0;
		byId("frame-after").disabled = index + 1 >= job.frames;
		const file = byId("frame-file");
		file.hidden = done < all || !job.frames_done;
		const name = job.pictures?.[index] ?? `${job.name}${job.animation ? String(model.number(index)).padStart(job.digits, "0") : ""}.${job.format}`;
		file.href = `/v1/jobs/${job.id}/frames/${encodeURIComponent(name)}`;
		file.download = name;
	}
}
