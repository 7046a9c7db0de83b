/** Where in the page somebody is: kept in the address behind `#`, so that it can be shared. */

export const TABS = ["inspect", "plan", "history", "runs", "do"] as const;
export type Tab = (typeof TABS)[number];
const QUERY = ["part", "rev", "op", "from", "to", "run", "t", "act"] as const;
export type Query = (typeof QUERY)[number];

export interface Where { bench: string | null; tab: Tab; query: Partial<Record<Query, string>> }

/** Read `#/LAB/BENCH/TAB?part=p2`. */
export function read(hash: string): Where {
  const [path = "", search = ""] = hash.replace(/^#\/?/, "").split("?");
  const [lab, bench, tab] = path.split("/").map(decodeURIComponent);
  const found = new URLSearchParams(search);
  const query: Where["query"] = {};
  for (const name of QUERY) if (found.get(name)) query[name] = found.get(name)!;
  return { bench: lab && bench ? `${lab}/${bench}` : null, tab: TABS.find((one) => one === tab) ?? "inspect", query };
}

export function written(where: Where): string {
  const search = new URLSearchParams(Object.entries(where.query).filter(([, value]) => value)).toString();
  return where.bench ? `#/${where.bench}/${where.tab}${search ? `?${search}` : ""}` : "#/";
}

class Address {
  now = $state<Where>(read(location.hash));

  constructor() {
    addEventListener("hashchange", () => (this.now = read(location.hash)));
  }

  go(tab: Tab, query: Where["query"] = {}): void {
    this.#to({ ...this.now, tab, query: { ...this.now.query, ...query } });
  }

  open(bench: string): void {
    this.#to({ ...this.now, bench });
  }

  set(query: Partial<Record<Query, string | null>>): void {
    const next = { ...this.now.query };
    for (const [name, value] of Object.entries(query) as [Query, string | null][]) {
      if (value) next[name] = value;
      else delete next[name];
    }
    this.#to({ ...this.now, query: next });
  }

  #to(where: Where): void {
    this.now = where;
    history.replaceState(null, "", `${location.pathname}${location.search}${written(where)}`);
  }
}

export const address = new Address();
