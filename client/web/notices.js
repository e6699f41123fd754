// What is to be known while it lasts, over the picture: the connection, the server's statuses.

import { sentence } from './connection.js';

export class Notices {
    constructor(list) {
        this.list_ = list;
        this.byKey_ = new Map();
    }

    // A status message: it replaces the one of the same key, and an empty one ends it.
    take({ key, level, message }) {
        if (message) this.byKey_.set(key, { level, message });
        else this.byKey_.delete(key);
        this.show_();
    }

    clear() {
        this.byKey_.clear();
        this.show_();
    }

    show_() {
        this.list_.hidden = this.byKey_.size === 0;
        this.list_.replaceChildren(...[...this.byKey_.values()].map(({ level, message }) => {
            const line = document.createElement('li');
            line.className = level;
            line.textContent = sentence({ message });
            return line;
        }));
    }
}
