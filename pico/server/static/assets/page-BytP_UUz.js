const __vite__mapDeps=(i,m=__vite__mapDeps,d=(m.f||(m.f=["assets/uPlot-CnsZ1jie.css"])))=>i.map(i=>d[i]);
var e=Array.isArray,t=Array.prototype.indexOf,n=Array.prototype.includes,r=Array.from,i=Object.defineProperty,a=Object.getOwnPropertyDescriptor,o=Object.getOwnPropertyDescriptors,s=Object.prototype,c=Array.prototype,l=Object.getPrototypeOf,u=Object.isExtensible,d=()=>{};function f(e){for(var t=0;t<e.length;t++)e[t]()}function p(){var e,t;return{promise:new Promise((n,r)=>{e=n,t=r}),resolve:e,reject:t}}function m(e,t){if(Array.isArray(e))return e;if(t===void 0||!(Symbol.iterator in e))return Array.from(e);let n=[];for(let r of e)if(n.push(r),n.length===t)break;return n}var h=1024,g=2048,_=4096,v=8192,y=16384,b=32768,x=1<<25,S=65536,C=1<<18,w=1<<19,T=1<<20,E=1<<25,D=1<<21,O=1<<22,ee=1<<23,k=Symbol(`$state`),te=Symbol(`component`),ne=Symbol(`legacy props`),re=Symbol(``),ie=Symbol(`attributes`),ae=Symbol(`class`),oe=Symbol(`style`),se=Symbol(`text`),ce=Symbol(`form reset`),le=new class extends Error{name=`StaleReactionError`;message="The reaction that called `getAbortSignal()` was re-run or destroyed"},ue=!!globalThis.document?.contentType&&globalThis.document.contentType.includes(`xml`),de={},fe=Symbol(`uninitialized`),pe=`http://www.w3.org/1999/xhtml`;function me(){console.warn(`https://svelte.dev/e/derived_inert`)}function he(e){console.warn(`https://svelte.dev/e/hydration_mismatch`)}function ge(){console.warn(`https://svelte.dev/e/select_multiple_invalid_value`)}function _e(){console.warn(`https://svelte.dev/e/svelte_boundary_reset_noop`)}var ve=!1;function ye(e){ve=e}var be;function xe(e){if(e===null)throw he(),de;return be=e}function Se(){return xe(an(be))}function A(e){if(ve){if(an(be)!==null)throw he(),de;be=e}}function Ce(e=1){if(ve){for(var t=e,n=be;t--;)n=an(n);be=n}}function we(e=!0){for(var t=0,n=be;;){if(n.nodeType===8){var r=n.data;if(r===`]`){if(t===0)return n;--t}else(r===`[`||r===`[!`||r[0]===`[`&&!isNaN(Number(r.slice(1))))&&(t+=1)}var i=an(n);e&&n.remove(),n=i}}function Te(e){if(!e||e.nodeType!==8)throw he(),de;return e.data}function Ee(e){return e===this.v}function De(e,t){return e==e?e!==t||typeof e==`object`&&!!e||typeof e==`function`:t==t}function j(e){return!De(e,this.v)}function Oe(e){throw Error(`https://svelte.dev/e/lifecycle_outside_component`)}function ke(){throw Error(`https://svelte.dev/e/async_derived_orphan`)}function Ae(e,t,n){throw Error(`https://svelte.dev/e/each_key_duplicate`)}function M(e){throw Error(`https://svelte.dev/e/effect_in_teardown`)}function je(){throw Error(`https://svelte.dev/e/effect_in_unowned_derived`)}function Me(e){throw Error(`https://svelte.dev/e/effect_orphan`)}function Ne(){throw Error(`https://svelte.dev/e/effect_update_depth_exceeded`)}function Pe(e){throw Error(`https://svelte.dev/e/props_invalid_value`)}function Fe(){throw Error(`https://svelte.dev/e/state_descriptors_fixed`)}function Ie(){throw Error(`https://svelte.dev/e/state_prototype_fixed`)}function Le(){throw Error(`https://svelte.dev/e/state_unsafe_mutation`)}function Re(){throw Error(`https://svelte.dev/e/svelte_boundary_reset_onerror`)}var ze=null;function Be(e){ze=e}function Ve(e,t=!1,n){ze={p:ze,i:!1,c:null,e:null,s:e,x:null,r:Un,l:null}}function He(e){var t=ze,n=t.e;if(n!==null){t.e=null;for(var r of n)vn(r)}return e!==void 0&&(t.x=e),t.i=!0,ze=t.p,Ue(e)}function Ue(e={}){return i(e,te,{value:!0}),e}function We(){return!0}var Ge=[];function Ke(){var e=Ge;Ge=[],f(e)}function qe(e){if(Ge.length===0&&!St){var t=Ge;queueMicrotask(()=>{t===Ge&&Ke()})}Ge.push(e)}function Je(){for(;Ge.length>0;)Ke()}var Ye=~(g|_|h);function Xe(e,t){e.f=e.f&Ye|t}function Ze(e){e.f&512||e.deps===null?Xe(e,h):Xe(e,_)}function Qe(e,t){e.f&2048?t.set(e,g):e.f&4096&&t.get(e)!==2048&&t.set(e,_),Xe(e,h)}function $e(e,t){if(t){let t=document.body;e.autofocus=!0,qe(()=>{document.activeElement===t&&e.focus()})}}var et=!1;function tt(){et||(et=!0,document.addEventListener(`reset`,e=>{Promise.resolve().then(()=>{if(!e.defaultPrevented)for(let t of e.target.elements)t[ce]?.()})},{capture:!0}))}function nt(e){var t=Bn,n=Un;Hn(null),Wn(null);try{return e()}finally{Hn(t),Wn(n)}}function rt(e,t,n,r=n){e.addEventListener(t,()=>nt(n));let i=e[ce];e[ce]=i?()=>{i(),r(!0)}:()=>r(!0),tt()}function it(e,t,n,r){let i=We()?ct:dt;var a=e.filter(e=>!e.settled),o=t.map(i);if(n.length===0&&a.length===0){r(o);return}var s=Un,c=at(),l=a.length===1?a[0].promise:a.length>1?Promise.all(a.map(e=>e.promise)):null;function u(e){if(!(s.f&16384)){c();try{r([...o,...e])}catch(e){dn(e,s)}ot()}}var d=st();if(n.length===0){l.then(()=>u([])).finally(d);return}function f(){Promise.all(n.map(e=>ut(e))).then(u).catch(e=>dn(e,s)).finally(d)}l?l.then(()=>{s.f&16384?d():(c(),f(),ot())}):f()}function at(){var e=Un,t=Bn,n=ze,r=vt;return function(i=!0){Wn(e),Hn(t),Be(n),i&&!(e.f&16384)&&(r?.activate(),r?.apply())}}function ot(e=!0){Wn(null),Hn(null),Be(null),e&&vt?.deactivate()}function st(){var e=Un,t=e.b,n=vt,r=!!t?.is_rendered();return t?.update_pending_count(1,n),n.increment(r,e),()=>{t?.update_pending_count(-1,n),n.decrement(r,e)}}function ct(e){var t=2|g;return Un!==null&&(Un.f|=w),{ctx:ze,deps:null,effects:null,equals:Ee,f:t,fn:e,reactions:null,rv:0,v:fe,wv:0,parent:Un,ac:null}}var lt=Symbol(`obsolete`);function ut(e,t,n){let r=Un;r===null&&ke();var i=void 0,a=zt(fe),o=!Bn,s=new Set;return xn(()=>{var t=Un,n=p();i=n.promise;try{Promise.resolve(e()).then(n.resolve,e=>{e!==le&&n.reject(e)}).finally(ot)}catch(e){n.reject(e),ot()}var c=vt;if(o){if(t.f&32768)var l=st();if(r.b?.is_rendered())c.async_deriveds.get(t)?.reject(lt);else for(let e of s.values())e.reject(lt);s.add(n),c.async_deriveds.set(t,n)}let u=(e,t=void 0)=>{l?.(),s.delete(n),t!==lt&&(c.activate(),t?(a.f|=ee,Ut(a,t)):(a.f&8388608&&(a.f^=ee),Ut(a,e)),c.deactivate())};n.promise.then(u,e=>u(null,e||`unknown`))}),gn(()=>{for(let e of s)e.reject(lt)}),new Promise(e=>{function t(n){function r(){n===i?e(a):t(i)}n.then(r,r)}t(i)})}function N(e){let t=ct(e);return Kn(t),t}function dt(e){let t=ct(e);return t.equals=j,t}function ft(e){var t=e.effects;if(t!==null){e.effects=null;for(var n=0;n<t.length;n+=1)kn(t[n])}}function pt(e){var t,n=Un,r=e.parent;if(!Rn&&r!==null&&e.v!==fe&&r.f&24576)return me(),e.v;Wn(r);try{ft(e),t=ir(e)}finally{Wn(n)}return t}function mt(e){var t=pt(e);!e.equals(t)&&(e.wv=tr(),(!vt?.is_fork||e.deps===null)&&(vt===null?e.v=t:(vt.capture(e,t,!0),yt?.capture(e,t,!0)),e.deps===null))?Xe(e,h):Rn||(bt===null?Ze(e):(hn()||vt?.is_fork)&&bt.set(e,t))}function ht(e){if(e.effects!==null)for(let t of e.effects)(t.teardown||t.ac)&&(t.teardown?.(),t.ac!==null&&nt(()=>{t.ac.abort(le),t.ac=null}),t.fn!==null&&(t.teardown=d),sr(t,0),Dn(t))}function gt(e){if(e.effects!==null)for(let t of e.effects)t.teardown&&t.fn!==null&&cr(t)}var _t=null,vt=null,yt=null,bt=null,xt=null,St=!1,Ct=!1,wt=null,Tt=null,Et=0,Dt=1,Ot=class e{id=Dt++;started=!1;linked=!0;prev=null;next=null;async_deriveds=new Map;current=new Map;previous=new Map;#e=new Set;#t=new Set;#n=0;#r=new Map;#i=null;#a=[];#o=[];#s=new Map;#c=new Map;#l=new Set;is_fork=!1;#u=!1;constructor(){_t===null?_t=this:(_t.next=this,this.prev=_t),_t=this}#d(){if(this.is_fork)return!0;for(let e of this.#r.keys())if(!this.#f(e))return!0;return!1}#f(e){for(var t=e;t!==null;t=t.parent)if(this.#c.has(t))return!0;return!1}skip_effect(e){this.#c.has(e)||this.#c.set(e,{d:[],m:[]}),this.#l.delete(e)}unskip_effect(e,t=e=>this.schedule(e)){var n=this.#c.get(e);if(n){this.#c.delete(e);for(var r of n.d)Xe(r,g),t(r);for(r of n.m)Xe(r,_),t(r)}this.#l.add(e)}#p(){var e=[];for(let i of this.#a)if(!(i.f&16384||!(i.f&6144))){for(var t=i,n=!1;t.parent!==null;){t=t.parent;var r=t.f;if(r&96){if(!(r&1024)){n=!0;break}t.f^=h}}n||e.push(t)}return this.#a=[],e}#m(){this.started=!0;for(let[e,t]of this.#s)Xe(e,t),this.schedule(e);this.apply();for(var t=wt=[],n=[],r=Tt=[];this.#a.length>0;){Et++>1e3&&(this.#b(),At());for(let e of this.#p())try{this.#h(e,t,n)}catch(t){throw Ft(e),this.#d()||this.discard(),t}}if(vt=null,r.length>0){var i=e.ensure();for(let e of r)i.schedule(e)}if(wt=null,Tt=null,this.#d()){this.#y(n),this.#y(t);for(let[e,t]of this.#c)Pt(e,t);r.length>0&&vt.#m();return}let a=this.#g();if(a)this.#y(n),this.#y(t),a.#v(this);else{this.#s.clear();for(let e of this.#e)e(this);this.#e.clear(),yt=this,Mt(n),Mt(t),yt=null,this.#i?.resolve();var o=vt;this.#n===0&&(this.#a.length===0||o!==null)&&this.#b(),o!==null&&(Lt.clear(),o.#m())}}#h(e,t,n){e.f^=h;for(var r=e.first;r!==null;){var i=r.f,a=!!(i&96);if(!(a&&i&1024||i&8192||this.#c.has(r))&&r.fn!==null){a?r.f^=h:i&4?t.push(r):nr(r)&&(i&16&&this.add_dirty_reaction(r,_),cr(r));var o=r.first;if(o!==null){r=o;continue}}for(;r!==null;){var s=r.next;if(s!==null){r=s;break}r=r.parent}}}#g(){for(var e=this.prev;e!==null;e=e.prev)if(!e.is_fork&&this.#_(e))return e;return null}#_(e){for(let[t,[,n]]of this.current)if(!n&&e.current.has(t))return!0;return!1}#v(e){for(let[t,n]of e.current)!this.previous.has(t)&&e.previous.has(t)&&this.previous.set(t,e.previous.get(t)),this.current.set(t,n);for(let[t,n]of e.async_deriveds){let e=this.async_deriveds.get(t);e&&n.promise.then(e.resolve).catch(e.reject)}e.async_deriveds.clear(),this.transfer_reactions(e.#s);let t=e=>{var n=e.reactions;if(n!==null&&!(e.f&2&&!(e.f&6144)))for(let e of n){var r=e.f;if(r&2)t(e);else{var i=e;r&4194320&&!this.async_deriveds.has(i)&&(this.#s.delete(i),Xe(i,g),this.schedule(i))}}};for(let e of this.current.keys())t(e);this.oncommit(()=>e.discard()),e.#b(),vt=this,this.#m()}#y(e){for(var t=0;t<e.length;t+=1)Qe(e[t],this.#s)}capture(e,t,n=!1){e.v!==fe&&!this.previous.has(e)&&this.previous.set(e,e.v),e.f&8388608||(this.current.set(e,[t,n]),bt?.set(e,t)),this.is_fork||(e.v=t)}activate(){vt=this}deactivate(){vt=null,bt=null}flush(){try{Ct=!0,vt=this,this.#m()}finally{Et=0,xt=null,wt=null,Tt=null,Ct=!1,vt=null,bt=null,Lt.clear()}}discard(){for(let e of this.#t)e(this);this.#t.clear();for(let e of this.async_deriveds.values())e.reject(lt);this.#b(),this.#i?.resolve()}register_created_effect(e){this.#o.push(e)}increment(e,t){if(this.#n+=1,e){let e=this.#r.get(t)??0;this.#r.set(t,e+1)}}decrement(e,t){if(--this.#n,e){let e=this.#r.get(t)??0;e===1?this.#r.delete(t):this.#r.set(t,e-1)}this.#u||(this.#u=!0,qe(()=>{this.#u=!1,this.linked&&this.flush()}))}transfer_reactions(e){for(let[t,n]of e)this.add_dirty_reaction(t,n);e.clear()}add_dirty_reaction(e,t){(t===2048||this.#s.get(e)!==2048)&&this.#s.set(e,t)}oncommit(e){this.#e.add(e)}ondiscard(e){this.#t.add(e)}settled(){return(this.#i??=p()).promise}static ensure(){if(vt===null){let t=vt=new e;!Ct&&!St&&qe(()=>{t.started||t.flush()})}return vt}apply(){bt=null}schedule(e){xt=e,e.b?.is_pending&&e.f&16777228&&!(e.f&32768)?e.b.defer_effect(e):this.#a.push(e)}#b(){if(this.linked){var e=this.prev,t=this.next;e===null||(e.next=t),t===null?_t=e:t.prev=e,this.linked=!1}}};function kt(e){var t=St,n=yt;yt=null,St=!0;try{var r;for(e&&(kt(),r=e());;){if(Je(),vt===null)return r;vt.flush()}}finally{St=t,yt=n}}function At(){try{Ne()}catch(e){dn(e,xt)}}var jt=null;function Mt(e){var t=e.length;if(t!==0){for(var n=0;n<t;){var r=e[n++];if(!(r.f&24576)&&nr(r)&&(jt=new Set,cr(r),r.deps===null&&r.first===null&&r.nodes===null&&r.teardown===null&&r.ac===null&&jn(r),jt?.size>0)){Lt.clear();for(let e of jt){if(e.f&24576)continue;let t=[e],n=e.parent;for(;n!==null;)jt.has(n)&&(jt.delete(n),t.push(n)),n=n.parent;for(let e=t.length-1;e>=0;e--){let n=t[e];n.f&24576||cr(n)}}jt.clear()}}jt=null}}function Nt(e){vt.schedule(e)}function Pt(e,t){if(!(e.f&32&&e.f&1024)){e.f&2048?t.d.push(e):e.f&4096&&t.m.push(e),Xe(e,h);for(var n=e.first;n!==null;)Pt(n,t),n=n.next}}function Ft(e){Xe(e,h);for(var t=e.first;t!==null;)Ft(t),t=t.next}var It=new Set,Lt=new Map,Rt=!1;function zt(e,t){return{f:0,v:e,reactions:null,equals:Ee,rv:0,wv:0}}function P(e,t){let n=zt(e,t);return Kn(n),n}function Bt(e,t=!1,n=!0){let r=zt(e);return t||(r.equals=j),r}function F(e,t,n=!1){return Bn!==null&&(!Vn||Bn.f&131072)&&We()&&Bn.f&4325394&&(Gn===null||!Gn.has(e))&&Le(),Ut(e,n?qt(t):t,Tt)}var Vt=null,Ht=0;function Ut(e,t,n=null){if(!e.equals(t)){Rn?Lt.set(e,t):Lt.has(e)||Lt.set(e,e.v);var r=Ot.ensure();if(r.capture(e,t),e.f&2){let t=e;e.f&2048&&pt(t),bt===null&&Ze(t)}e.wv=tr(),Vt=null,Ht=0,Kt(e,g,n),Vt=null,We()&&Un!==null&&Un.f&1024&&!(Un.f&96)&&(Yn===null?Xn([e]):Yn.push(e)),!r.is_fork&&It.size>0&&!Rt&&Wt()}return t}function Wt(){Rt=!1;for(let e of It){e.f&1024&&Xe(e,_);let t;try{t=nr(e)}catch{t=!0}t&&cr(e)}It.clear()}function Gt(e){F(e,e.v+1)}function Kt(e,t,n){var r=e.reactions;if(r!==null){var i=We(),a=r.length;if(Ht+=a,Ht>1e5&&Vt===null&&(Vt=new Set),Vt!==null){if(Vt.has(e))return;Vt.add(e)}for(var o=0;o<a;o++){var s=r[o],c=s.f;if(i||s!==Un){var l=(c&g)===0;if(l&&Xe(s,t),c&131072)It.add(s);else if(c&2){var u=s;bt?.delete(u),Kt(u,_,n)}else if(l){var d=s;c&16&&jt!==null&&jt.add(d),n===null?Nt(d):n.push(d)}}}}}function qt(t){if(typeof t!=`object`||!t||k in t||te in t)return t;let n=l(t);if(n!==s&&n!==c)return t;var r=new Map,i=e(t),o=P(0),u=null,d=$n,f=e=>{if($n===d)return e();var t=Bn,n=$n;Hn(null),er(d);var r=e();return Hn(t),er(n),r};return i&&r.set(`length`,P(t.length,u)),new Proxy(t,{defineProperty(e,t,n){`value`in n&&n.configurable!==!1&&n.enumerable!==!1&&n.writable!==!1||Fe();var i=r.get(t);return i===void 0?f(()=>{var e=P(n.value,u);return r.set(t,e),e}):F(i,n.value,!0),!0},deleteProperty(e,t){var n=r.get(t);if(n===void 0){if(t in e){let e=f(()=>P(fe,u));r.set(t,e),Gt(o)}}else F(n,fe),Gt(o);return!0},get(e,n,i){if(n===k)return t;var o=r.get(n),s=n in e;if(o===void 0&&(!s||a(e,n)?.writable)&&(o=f(()=>P(qt(s?e[n]:fe),u)),r.set(n,o)),o!==void 0){var c=V(o);return c===fe?void 0:c}return Reflect.get(e,n,i)},getOwnPropertyDescriptor(e,t){this.has?.(e,t);var n=Reflect.getOwnPropertyDescriptor(e,t),i=r.get(t);if(i!==void 0){var a=V(i);if(a===fe)return;if(n&&`value`in n)n.value=a;else return{enumerable:!0,configurable:!0,value:a,writable:!0}}return n},has(e,t){if(t===k)return!0;var n=r.get(t),i=n!==void 0&&n.v!==fe||Reflect.has(e,t);return(n!==void 0||(Un!==null||Bn!==null)&&(!i||a(e,t)?.writable))&&(n===void 0&&(n=f(()=>P(i?qt(e[t]):fe,u)),r.set(t,n)),V(n)===fe)?!1:i},set(e,t,n,s){var c=r.get(t),l=t in e;if(i&&t===`length`)for(var d=n;d<c.v;d+=1){var p=r.get(d+``);p===void 0?d in e&&(p=f(()=>P(fe,u)),r.set(d+``,p)):F(p,fe)}if(c===void 0)(!l||a(e,t)?.writable)&&(c=f(()=>P(void 0,u)),F(c,qt(n)),r.set(t,c));else{l=c.v!==fe;var m=f(()=>qt(n));F(c,m)}var h=Reflect.getOwnPropertyDescriptor(e,t);if(h?.set&&h.set.call(s,n),!l){if(i&&typeof t==`string`){var g=r.get(`length`),_=Number(t);Number.isInteger(_)&&_>=g.v&&F(g,_+1)}Gt(o)}return!0},ownKeys(e){V(o);var t=Reflect.ownKeys(e).filter(e=>{var t=r.get(e);return t===void 0||t.v!==fe});for(var[n,i]of r)i.v!==fe&&!(n in e)&&t.push(n);return t},setPrototypeOf(){Ie()}})}function Jt(e){try{if(typeof e==`object`&&e&&k in e)return e[k]}catch{}return e}function Yt(e,t){return Object.is(Jt(e),Jt(t))}var Xt,Zt,Qt,$t,en;function tn(){if(Xt===void 0){Xt=window,Zt=document,Qt=/Firefox/.test(navigator.userAgent);var e=Element.prototype,t=Node.prototype,n=Text.prototype;$t=a(t,`firstChild`).get,en=a(t,`nextSibling`).get,u(e)&&(e[ae]=void 0,e[ie]=null,e[oe]=void 0,e.__e=void 0),u(n)&&(n[se]=void 0)}}function nn(e=``){return document.createTextNode(e)}function rn(e){return $t.call(e)}function an(e){return en.call(e)}function I(e,t){if(!ve)return rn(e);var n=rn(be);if(n===null)n=be.appendChild(nn());else if(t&&n.nodeType!==3){var r=nn();return n?.before(r),xe(r),r}return t&&ln(n),xe(n),n}function L(e,t=!1){if(!ve){var n=rn(e);return n instanceof Comment&&n.data===``?an(n):n}if(t){if(be?.nodeType!==3){var r=nn();return be?.before(r),xe(r),r}ln(be)}return be}function R(e,t=!1){if(!ve)return rn(e);var n=I(e,t);return A(e),n}function z(e,t=1,n=!1){let r=ve?be:e;for(var i;t--;)i=r,r=an(r);if(!ve)return r;if(n){if(r?.nodeType!==3){var a=nn();return r===null?i?.after(a):r.before(a),xe(a),a}ln(r)}return xe(r),r}function on(e){e.textContent=``}function sn(){return!1}function cn(e,t,n){return t==null||t===`http://www.w3.org/1999/xhtml`?n?document.createElement(e,{is:n}):document.createElement(e):n?document.createElementNS(t,e,{is:n}):document.createElementNS(t,e)}function ln(e){if(e.nodeValue.length<65536)return;let t=e.nextSibling;for(;t!==null&&t.nodeType===3;)t.remove(),e.nodeValue+=t.nodeValue,t=e.nextSibling}function un(e){var t=Un;if(t===null)return Bn.f|=ee,e;if(!(t.f&32768)&&!(t.f&4))throw e;dn(e,t)}function dn(e,t){if(e===de)throw e;if(!(t!==null&&t.f&16384)){for(;t!==null;){if(t.f&128&&!(t.f&33570816)){if(!(t.f&32768))throw e;try{t.b.error(e);return}catch(t){e=t}}t=t.parent}throw e}}function fn(e){Un===null&&(Bn===null&&Me(e),je()),Rn&&M(e)}function pn(e,t){var n=t.last;n===null?t.last=t.first=e:(n.next=e,e.prev=n,t.last=e)}function mn(e,t){var n=Un;n!==null&&n.f&8192&&(e|=v);var r={ctx:ze,deps:null,nodes:null,f:e|g|512,first:null,fn:t,last:null,next:null,parent:n,b:n&&n.b,prev:null,teardown:null,wv:0,ac:null};vt?.register_created_effect(r);var i=r;if(e&4)wt===null?Ot.ensure().schedule(r):wt.push(r);else if(t!==null){try{cr(r)}catch(e){throw kn(r),e}i.deps===null&&i.teardown===null&&i.nodes===null&&i.first===i.last&&!(i.f&524288)&&(i=i.first,e&16&&e&65536&&i!==null&&(i.f|=S))}if(i!==null&&(i.parent=n,n!==null&&pn(i,n),Bn!==null&&Bn.f&2&&!(e&64))){var a=Bn;(a.effects??=[]).push(i)}return r}function hn(){return Bn!==null&&!Vn}function gn(e){let t=mn(8,null);return Xe(t,h),t.teardown=e,t}function _n(e){fn(`$effect`);var t=Un.f;if(!Bn&&t&32&&ze!==null&&!ze.i){var n=ze;(n.e??=[]).push(e)}else return vn(e)}function vn(e){return mn(4|T,e)}function yn(e){Ot.ensure();let t=mn(64|w,e);return(e={})=>new Promise(n=>{e.outro?Mn(t,()=>{kn(t),n(void 0)}):(kn(t),n(void 0))})}function bn(e){return mn(4,e)}function xn(e){return mn(O|w,e)}function Sn(e,t=0){return mn(8|t,e)}function B(e,t=[],n=[],r=[]){it(r,t,n,t=>{mn(8,()=>{e(...t.map(V))})})}function Cn(e,t=[],n=[],r=[]){it(r,t,n,t=>{mn(4,()=>e(...t.map(V)))})}function wn(e,t=0){return mn(16|t,e)}function Tn(e){return mn(32|w,e)}function En(e){var t=e.teardown;if(t!==null){let n=Rn,r=Bn;zn(!0),Hn(null);try{t.call(null)}catch(t){dn(t,e.parent)}finally{zn(n),Hn(r)}}}function Dn(e,t=!1){var n=e.first;for(e.first=e.last=null;n!==null;){let e=n.ac;e!==null&&nt(()=>{e.abort(le)});var r=n.next;n.f&64?n.parent=null:kn(n,t),n=r}}function On(e){for(var t=e.first;t!==null;){var n=t.next;t.f&32||kn(t),t=n}}function kn(e,t=!0){var n=!1;(t||e.f&262144)&&e.nodes!==null&&e.nodes.end!==null&&(An(e.nodes.start,e.nodes.end),n=!0),e.f|=x,Dn(e,t&&!n),sr(e,0);var r=e.nodes&&e.nodes.t;if(r!==null)for(let e of r)e.stop();En(e),e.f^=x,e.f|=y;var i=e.parent;i!==null&&i.first!==null&&jn(e),e.next=e.prev=e.teardown=e.ctx=e.deps=e.fn=e.nodes=e.ac=e.b=null}function An(e,t){for(;e!==null;){var n=e===t?null:an(e);e.remove(),e=n}}function jn(e){var t=e.parent,n=e.prev,r=e.next;n!==null&&(n.next=r),r!==null&&(r.prev=n),t!==null&&(t.first===e&&(t.first=r),t.last===e&&(t.last=n))}function Mn(e,t,n=!0){var r=[];e.f|=256,Nn(e,r,!0);var i=()=>{n&&kn(e),t&&t()},a=r.length;if(a>0){var o=()=>--a||i();for(var s of r)s.out(o)}else i()}function Nn(e,t,n){if(!(e.f&8192)){e.f^=v;var r=e.nodes&&e.nodes.t;if(r!==null)for(let e of r)(e.is_global||n)&&t.push(e);for(var i=e.first;i!==null;){var a=i.next;if(!(i.f&64)){var o=!!(i.f&65536)||!!(i.f&32)&&!!(e.f&16);Nn(i,t,o?n:!1)}i=a}}}function Pn(e){e.f&=-257,Fn(e,!0)}function Fn(e,t){if(!(e.f&256)&&e.f&8192){e.f^=v,e.f&1024||(Xe(e,g),Ot.ensure().schedule(e));for(var n=e.first;n!==null;){var r=n.next,i=!!(n.f&65536)||!!(n.f&32);Fn(n,i?t:!1),n=r}var a=e.nodes&&e.nodes.t;if(a!==null)for(let e of a)(e.is_global||t)&&e.in()}}function In(e,t){if(e.nodes)for(var n=e.nodes.start,r=e.nodes.end;n!==null;){var i=n===r?null:an(n);t.append(n),n=i}}var Ln=null,Rn=!1;function zn(e){Rn=e}var Bn=null,Vn=!1;function Hn(e){Bn=e}var Un=null;function Wn(e){Un=e}var Gn=null;function Kn(e){Bn!==null&&(Bn.f&2097152||Bn.f&2)&&(Gn??=new Set).add(e)}var qn=null,Jn=0,Yn=null;function Xn(e){Yn=e}var Zn=1,Qn=0,$n=Qn;function er(e){$n=e}function tr(){return++Zn}function nr(e){var t=e.f;if(t&2048)return!0;if(t&4096){for(var n=e.deps,r=n.length,i=0;i<r;i++){var a=n[i];if(nr(a)&&mt(a),a.wv>e.wv)return!0}t&512&&bt===null&&Xe(e,h)}return!1}function rr(e,t,n=!0){var r=e.reactions;if(r!==null&&!(Gn!==null&&Gn.has(e)))for(var i=0;i<r.length;i++){var a=r[i];a.f&2?rr(a,t,!1):t===a&&(n?Xe(a,g):a.f&1024&&Xe(a,_),Nt(a))}}function ir(e){var t=qn,n=Jn,r=Yn,i=Bn,a=Gn,o=ze,s=Vn,c=$n,l=e.f;qn=null,Jn=0,Yn=null,Bn=l&96?null:e,Gn=null,Be(e.ctx),Vn=!1,$n=++Qn,e.ac!==null&&(nt(()=>{e.ac.abort(le)}),e.ac=null);try{e.f|=D;var u=e.fn,d=u();e.f|=b;var f=ar(e);if(We()&&Yn!==null&&!Vn&&f!==null&&!(e.f&6146))for(var p=0;p<Yn.length;p++)rr(Yn[p],e);if(i!==null&&i!==e){if(Qn++,i.deps!==null)for(let e=0;e<n;e+=1)i.deps[e].rv=Qn;if(t!==null)for(let e of t)e.rv=Qn;Yn!==null&&(r===null?r=Yn:r.push(...Yn))}return e.f&8388608&&(e.f^=ee),d}catch(t){return ar(e),un(t)}finally{e.f^=D,qn=t,Jn=n,Yn=r,Bn=i,Gn=a,Be(o),Vn=s,$n=c}}function ar(e){var t=e.deps,n=vt?.is_fork;if(qn!==null){var r;if(n||sr(e,Jn),t!==null&&Jn>0)for(t.length=Jn+qn.length,r=0;r<qn.length;r++)t[Jn+r]=qn[r];else e.deps=t=qn;if(hn()&&e.f&512)for(r=Jn;r<t.length;r++)(t[r].reactions??=[]).push(e)}else!n&&t!==null&&Jn<t.length&&(sr(e,Jn),t.length=Jn);return t}function or(e,r){let i=r.reactions;if(i!==null){var a=t.call(i,e);if(a!==-1){var o=i.length-1;o===0?i=r.reactions=null:(i[a]=i[o],i.pop())}}if(i===null&&r.f&2&&(qn===null||!n.call(qn,r))){var s=r;s.f&512&&(s.f^=512),s.v!==fe&&Ze(s),s.ac!==null&&nt(()=>{s.ac.abort(le),s.ac=null,Xe(s,g)}),ht(s),sr(s,0)}}function sr(e,t){var n=e.deps;if(n!==null)for(var r=t;r<n.length;r++)or(e,n[r])}function cr(e){var t=e.f;if(!(t&16384)){Xe(e,h);var n=Un;Un=e;try{t&16777232?On(e):Dn(e),En(e);var r=ir(e);e.teardown=typeof r==`function`?r:null,e.wv=Zn}finally{Un=n}}}async function lr(){await Promise.resolve(),kt()}function V(e){var t=!!(e.f&2);if(Ln?.add(e),Bn!==null&&!Vn&&!(Un!==null&&Un.f&16384)&&(Gn===null||!Gn.has(e))){var r=Bn.deps;if(Bn.f&2097152)e.rv<Qn&&(e.rv=Qn,qn===null&&r!==null&&r[Jn]===e?Jn++:qn===null?qn=[e]:qn.push(e));else{Bn.deps??=[],n.call(Bn.deps,e)||Bn.deps.push(e);var i=e.reactions;i===null?e.reactions=[Bn]:n.call(i,Bn)||i.push(Bn)}}if(Rn&&Lt.has(e))return Lt.get(e);if(t){var a=e;if(Rn){var o=a.v;return(!(a.f&1024)&&a.reactions!==null||dr(a))&&(o=pt(a)),Lt.set(a,o),o}var s=!(a.f&512)&&!Vn&&Bn!==null&&!!(Bn.f&512),c=(a.f&b)===0;nr(a)&&(s&&(a.f|=512),mt(a)),s&&!c&&(gt(a),ur(a))}if(bt?.has(e))return bt.get(e);if(e.f&8388608)throw e.v;return e.v}function ur(e){if(e.f|=512,e.deps!==null)for(let r of e.deps){var t=r.reactions;t===null?r.reactions=[e]:n.call(t,e)||t.push(e),r.f&2&&!(r.f&512)&&(gt(r),ur(r))}}function dr(e){if(e.v===fe)return!0;if(e.deps===null)return!1;for(let t of e.deps)if(Lt.has(t)||t.f&2&&dr(t))return!0;return!1}function fr(e){var t=Vn;try{return Vn=!0,e()}finally{Vn=t}}function pr(e){if(!(typeof e!=`object`||!e||e instanceof EventTarget)){if(k in e)mr(e);else if(!Array.isArray(e))for(let t in e){let n=e[t];typeof n==`object`&&n&&k in n&&mr(n)}}}function mr(e,t=new Set){if(typeof e==`object`&&e&&!(e instanceof EventTarget)&&!t.has(e)){t.add(e),e instanceof Date&&e.getTime();for(let n in e)try{mr(e[n],t)}catch{}let n=l(e);if(n!==Object.prototype&&n!==Array.prototype&&n!==Map.prototype&&n!==Set.prototype&&n!==Date.prototype){let t=o(n);for(let n in t){let r=t[n].get;if(r)try{r.call(e)}catch{}}}}}[...`allowfullscreen.async.autofocus.autoplay.checked.controls.default.disabled.formnovalidate.indeterminate.inert.ismap.loop.multiple.muted.nomodule.novalidate.open.playsinline.readonly.required.reversed.seamless.selected.webkitdirectory.defer.disablepictureinpicture.disableremoteplayback`.split(`.`)];var hr=[`touchstart`,`touchmove`];function gr(e){return hr.includes(e)}var _r=Symbol(`events`),vr=new Set,yr=new Set;function br(e,t,n,r={}){function i(e){if(r.capture||Tr.call(t,e),!e.cancelBubble)return nt(()=>n?.call(this,e))}return e.startsWith(`pointer`)||e.startsWith(`touch`)||e===`wheel`?(i.__removed=!1,qe(()=>{i.__removed||t.addEventListener(e,i,r)})):t.addEventListener(e,i,r),i}function xr(e,t,n,r,i){var a={capture:r,passive:i},o=br(e,t,n,a);(t===document.body||t===window||t===document||t instanceof HTMLMediaElement)&&gn(()=>{o.__removed=!0,t.removeEventListener(e,o,a)})}function H(e,t,n){(t[_r]??={})[e]=n}function Sr(e){for(var t=0;t<e.length;t++)vr.add(e[t]);for(var n of yr)n(e)}var Cr=null,wr=!1;function Tr(e){var t=this,n=t.ownerDocument,r=e.type,a=e.composedPath?.()||[],o=a[0]||e.target;Cr=e,wr||(wr=!0,setTimeout(()=>{wr=!1,Cr=null}));var s=0,c=Cr===e&&e[_r];if(c){var l=a.indexOf(c);if(l!==-1&&(t===document||t===window)){e[_r]=t;return}var u=a.indexOf(t);if(u===-1)return;l<=u&&(s=l)}if(o=a[s]||e.target,o!==t){i(e,`currentTarget`,{configurable:!0,get(){return o||n}});var d=Bn,f=Un;Hn(null),Wn(null);try{for(var p,m=[];o!==null&&o!==t;){try{var h=o[_r]?.[r];h==null||o.disabled&&e.target!==o||h.call(o,e)}catch(e){p?m.push(e):p=e}if(e.cancelBubble)break;s++,o=s<a.length?a[s]:null}if(p){for(let e of m)queueMicrotask(()=>{throw e});throw p}}finally{e[_r]=t,delete e.currentTarget,Hn(d),Wn(f)}}}var Er=globalThis?.window?.trustedTypes&&globalThis.window.trustedTypes.createPolicy(`svelte-trusted-html`,{createHTML:e=>e});function Dr(e){return Er?.createHTML(e)??e}function Or(e){var t=cn(`template`);return t.innerHTML=Dr(e.replaceAll(`<!>`,`<!---->`)),t.content}function kr(e,t){var n=Un;n.nodes===null&&(n.nodes={start:e,end:t,a:null,t:null})}function U(e,t){var n=!!(t&1),r=!!(t&2),i,a=!e.startsWith(`<!>`);return()=>{if(ve)return kr(be,null),be;i===void 0&&(i=Or(a?e:`<!>`+e),n||(i=rn(i)));var t=r||Qt?document.importNode(i,!0):i.cloneNode(!0);if(n){var o=rn(t),s=t.lastChild;kr(o,s)}else kr(t,t);return t}}function Ar(e,t,n=`svg`){var r=!e.startsWith(`<!>`),i=!!(t&1),a=`<${n}>${r?e:`<!>`+e}</${n}>`,o;return()=>{if(ve)return kr(be,null),be;if(!o){var e=rn(Or(a));if(i)for(o=document.createDocumentFragment();rn(e);)o.appendChild(rn(e));else o=rn(e)}var t=o.cloneNode(!0);if(i){var n=rn(t),r=t.lastChild;kr(n,r)}else kr(t,t);return t}}function jr(e,t){return Ar(e,t,`svg`)}function Mr(e=``){if(!ve){var t=nn(e+``);return kr(t,t),t}var n=be;return n.nodeType===3?ln(n):(n.before(n=nn()),xe(n)),kr(n,n),n}function Nr(){if(ve)return kr(be,null),be;var e=document.createDocumentFragment(),t=document.createComment(``),n=nn();return e.append(t,n),kr(t,n),e}function W(e,t){if(ve){var n=Un;n.f&32768&&n.nodes.end!==null||(n.nodes.end=be),Se()}else e!==null&&e.before(t)}function Pr(e){let t=0,n=zt(0),r;return()=>{hn()&&(V(n),Sn(()=>(t===0&&(r=fr(()=>e(()=>Gt(n)))),t+=1,()=>{qe(()=>{--t,t===0&&(r?.(),r=void 0,Gt(n))})})))}}var Fr=S|w;function Ir(e,t,n,r){new Lr(e,t,n,r)}var Lr=class{parent;is_pending=!1;transform_error;#e;#t=ve?be:null;#n;#r;#i;#a=null;#o=null;#s=null;#c=null;#l=0;#u=0;#d=!1;#f=new Map;#p=null;#m=Pr(()=>(this.#p=zt(this.#l),()=>{this.#p=null}));constructor(e,t,n,r){this.#e=e,this.#n=t,this.#r=e=>{var t=Un;t.b=this,t.f|=128,n(e)},this.parent=Un.b,this.transform_error=r??this.parent?.transform_error??(e=>e),this.#i=wn(()=>{if(ve){let e=Te(this.#t);Se();let t=e===`[!`;if(e.startsWith(`[?`)){let t=JSON.parse(e.slice(2));this.#g(t)}else t?this.#y():this.#h()}else this.#b()},Fr),ve&&(this.#e=be)}#h(){try{this.#a=Tn(()=>this.#r(this.#e))}catch(e){this.error(e)}}#g(e){let t=this.#n.failed,{reset:n,invoke_onerror:r}=this.#_(e);qe(r),t&&(this.#s=Tn(()=>{t(this.#e,()=>e,()=>n)}))}#_(e){var t=!1,n=!1;let r=()=>{this.#v()||(t?_e():(t=!0,n&&Re(),this.#s!==null&&Mn(this.#s,()=>{this.#s=null}),this.#S(()=>{this.#b()})))};return{reset:r,invoke_onerror:()=>{if(!this.#v())try{n=!0,this.#n.onerror?.(e,r),n=!1}catch(e){dn(e,this.#i&&this.#i.parent)}}}}#v(){return(this.#i.f&(y|x))!==0}#y(){let e=this.#n.pending;e&&(this.is_pending=!0,this.#o=Tn(()=>e(this.#e)),qe(()=>{if(!this.#v()){var e=this.#c=document.createDocumentFragment(),t=nn(),n=!1;e.append(t),this.#a=this.#S(()=>{try{return Tn(()=>this.#r(t))}catch(e){try{this.error(e),n=!0}catch(e){dn(e,this.#i.parent)}return null}}),this.#a===null?(this.#c=null,n&&this.#x(vt)):this.#u===0&&(this.#e.before(e),this.#c=null,Mn(this.#o,()=>{this.#o=null}),this.#x(vt))}}))}#b(){try{if(this.is_pending=this.has_pending_snippet(),this.#u=0,this.#l=0,this.#a=Tn(()=>{this.#r(this.#e)}),this.#u>0){var e=this.#c=document.createDocumentFragment();In(this.#a,e);let t=this.#n.pending;this.#o=Tn(()=>t(this.#e))}else this.#x(vt)}catch(e){this.error(e)}}#x(e){this.is_pending=!1,e.transfer_reactions(this.#f)}defer_effect(e){Qe(e,this.#f)}is_rendered(){return!this.is_pending&&(!this.parent||this.parent.is_rendered())}has_pending_snippet(){return!!this.#n.pending}#S(e){var t=Un,n=Bn,r=ze;Wn(this.#i),Hn(this.#i),Be(this.#i.ctx);try{return Ot.ensure(),e()}finally{Wn(t),Hn(n),Be(r)}}#C(e,t){this.has_pending_snippet()?(this.#u+=e,this.#u===0&&(this.#x(t),this.#o&&Mn(this.#o,()=>{this.#o=null}),this.#c&&=(this.#e.before(this.#c),null))):this.parent&&this.parent.#C(e,t)}update_pending_count(e,t){this.#C(e,t),this.#l+=e,!this.#p||this.#d||(this.#d=!0,qe(()=>{this.#d=!1,this.#p&&Ut(this.#p,this.#l)}))}get_effect_pending(){return this.#m(),V(this.#p)}error(e){if(e===de||!this.#n.onerror&&!this.#n.failed)throw e;vt?.is_fork?(this.#a&&vt.skip_effect(this.#a),this.#o&&vt.skip_effect(this.#o),this.#s&&vt.skip_effect(this.#s),vt.oncommit(()=>{this.#v()||this.#w(e)})):this.#w(e)}#w(e){this.#a&&=(kn(this.#a),null),this.#o&&=(kn(this.#o),null),this.#s&&=(kn(this.#s),null),ve&&(xe(this.#t),Ce(),xe(we()));let t=this.#n.failed,n=e=>{if(this.#v())return;let{reset:n,invoke_onerror:r}=this.#_(e);r(),t&&!this.#v()&&(this.#s=this.#S(()=>{try{return Tn(()=>{var r=Un;r.b=this,r.f|=128,t(this.#e,()=>e,()=>n)})}catch(e){return dn(e,this.#i.parent),null}}))};qe(()=>{if(!this.#v()){var t;try{t=this.transform_error(e)}catch(e){dn(e,this.#i&&this.#i.parent);return}typeof t==`object`&&t&&typeof t.then==`function`?t.then(n,e=>dn(e,this.#i&&this.#i.parent)):n(t)}})}};function G(e,t){var n=t==null?``:typeof t==`object`?`${t}`:t;n!==(e[se]??=e.nodeValue)&&(e[se]=n,e.nodeValue=`${n}`)}function Rr(e,t){return Br(e,t)}var zr=new Map;function Br(e,{target:t,anchor:n,props:i={},events:a,context:o,intro:s=!0,transformError:c}){tn();var l=void 0,u=yn(()=>{var s=n??t.appendChild(nn());Ir(s,{pending:()=>{}},t=>{Ve({});var n=ze;if(o&&(n.c=o),a&&(i.$$events=a),ve&&kr(t,null),l=e(t,i)||Ue(),ve&&(Un.nodes.end=be,be===null||be.nodeType!==8||be.data!==`]`))throw he(),de;He()},c);var u=new Set,d=e=>{for(var n=0;n<e.length;n++){var r=e[n];if(!u.has(r)){u.add(r);var i=gr(r);for(let e of[t,document]){var a=zr.get(e);a===void 0&&(a=new Map,zr.set(e,a));var o=a.get(r);o===void 0?(e.addEventListener(r,Tr,{passive:i}),a.set(r,1)):a.set(r,o+1)}}}};return d(r(vr)),yr.add(d),()=>{for(var e of u)for(let n of[t,document]){var r=zr.get(n),i=r.get(e);--i==0?(n.removeEventListener(e,Tr),r.delete(e),r.size===0&&zr.delete(n)):r.set(e,i)}yr.delete(d),s!==n&&s.parentNode?.removeChild(s)}});return Vr.set(l,u),l}var Vr=new WeakMap,Hr=class{anchor;#e=new Map;#t=new Map;#n=new Map;#r=new Set;#i=!0;constructor(e,t=!0){this.anchor=e,this.#i=t}#a=e=>{if(this.#e.has(e)){var t=this.#e.get(e),n=this.#t.get(t);if(n)Pn(n),this.#r.delete(t);else{var r=this.#n.get(t);r&&(Pn(r.effect),this.#t.set(t,r.effect),this.#n.delete(t),r.fragment.lastChild.remove(),this.anchor.before(r.fragment),n=r.effect)}for(let[t,n]of this.#e){if(this.#e.delete(t),t===e)break;let r=this.#n.get(n);r&&(kn(r.effect),this.#n.delete(n))}for(let[e,r]of this.#t){if(e===t||this.#r.has(e))continue;let i=()=>{if(Array.from(this.#e.values()).includes(e)){var t=document.createDocumentFragment();In(r,t),t.append(nn()),this.#n.set(e,{effect:r,fragment:t})}else kn(r);this.#r.delete(e),this.#t.delete(e)};this.#i||!n?(this.#r.add(e),Mn(r,i,!1)):i()}}};#o=e=>{this.#e.delete(e);let t=Array.from(this.#e.values());for(let[e,n]of this.#n)t.includes(e)||(kn(n.effect),this.#n.delete(e))};ensure(e,t){var n=vt,r=sn();if(t&&!this.#t.has(e)&&!this.#n.has(e)){if(r){var i=document.createDocumentFragment(),a=nn();i.append(a),this.#n.set(e,{effect:Tn(()=>t(a)),fragment:i})}else this.#t.set(e,Tn(()=>t(this.anchor)))}if(this.#e.set(n,e),r){for(let[t,r]of this.#t)t===e?n.unskip_effect(r):n.skip_effect(r);for(let[t,r]of this.#n)t===e?n.unskip_effect(r.effect):n.skip_effect(r.effect);n.oncommit(this.#a),n.ondiscard(this.#o)}else ve&&(this.anchor=be),this.#a(n)}};function K(e,t,n=!1){var r;ve&&(r=be,Se());var i=new Hr(e),a=n?S:0;function o(e,t){if(ve){var n=Te(r);if(e!==parseInt(n.substring(1))){var a=we();xe(a),i.anchor=a,ye(!1),i.ensure(e,t),ye(!0);return}}i.ensure(e,t)}wn(()=>{var e=!1;t((t,n=0)=>{e=!0,o(n,t)}),e||o(-1,null)},a)}var Ur=Symbol(`NaN`);function Wr(e,t,n){ve&&Se();var r=new Hr(e),i=!We();wn(()=>{var e=t();e!==e&&(e=Ur),i&&typeof e==`object`&&e&&(e={}),r.ensure(e,n)})}function Gr(e,t){return t}function Kr(e,t,n){for(var i=[],a=t.length,o,s=t.length,c=0;c<a;c++){let n=t[c];Mn(n,()=>{if(o){if(o.pending.delete(n),o.done.add(n),o.pending.size===0){var t=e.outrogroups;qr(e,r(o.done)),t.delete(o),t.size===0&&(e.outrogroups=null)}}else--s},!1)}if(s===0){var l=i.length===0&&n!==null&&e.pending.size===0;if(l){var u=n,d=u.parentNode;on(d),d.append(u),e.items.clear()}qr(e,t,!l)}else o={pending:new Set(t),done:new Set},(e.outrogroups??=new Set).add(o)}function qr(e,t,n=!0){var r;if(e.pending.size>0){r=new Set;for(let t of e.pending.values())for(let n of t)r.add(e.items.get(n).e)}for(var i=0;i<t.length;i++){var a=t[i];r?.has(a)?(a.f|=E,In(a,document.createDocumentFragment())):kn(t[i],n)}}var Jr;function q(t,n,i,a,o,s=null){var c=t,l=new Map;if(n&4){var u=t;c=ve?xe(rn(u)):u.appendChild(nn())}ve&&Se();var d=null,f=dt(()=>{var t=i();return e(t)?t:t==null?[]:r(t)}),p=new Map,m=!0;function h(e){if(!(_.effect.f&16384)){_.pending.delete(e);var t=V(f);_.fallback=d,Xr(_,t,c,n,a),d!==null&&(t.length===0?d.f&33554432?(d.f^=E,Qr(d,null,c)):Pn(d):Mn(d,()=>{d=null}))}}function g(e){_.pending.delete(e)}var _={effect:wn(()=>{var e=V(f),t=e.length;let r=!1;ve&&Te(c)===`[!`!=(t===0)&&(c=we(),xe(c),ye(!1),r=!0);for(var u=new Set,_=vt,v=sn(),y=0;y<t;y+=1){ve&&be.nodeType===8&&be.data===`]`&&(c=be,r=!0,ye(!1));var b=e[y],x=a(b,y),S=m?null:l.get(x);S?(S.v&&Ut(S.v,b),S.i&&Ut(S.i,y),v&&_.unskip_effect(S.e)):(S=Zr(l,m?c:Jr??=nn(),b,x,y,o,n,i),m||(S.e.f|=E),l.set(x,S)),u.add(x)}if(t===0&&s&&!d&&(m?d=Tn(()=>s(c)):(d=Tn(()=>s(Jr??=nn())),d.f|=E)),t>u.size&&Ae(``,``,``),ve&&t>0&&xe(we()),!m){if(p.set(_,u),v){for(let[e,t]of l)u.has(e)||_.skip_effect(t.e);_.oncommit(h),_.ondiscard(g)}else h(_)}r&&ye(!0),V(f)}),flags:n,items:l,pending:p,outrogroups:null,fallback:d};m=!1,ve&&(c=be)}function Yr(e){for(;e!==null&&!(e.f&32);)e=e.next;return e}function Xr(e,t,n,i,a){var o=!!(i&8),s=t.length,c=e.items,l=Yr(e.effect.first),u,d=null,f,p=[],m=[],h,g,_,v;if(o)for(v=0;v<s;v+=1)h=t[v],g=a(h,v),_=c.get(g).e,_.f&33554432||(_.nodes?.a?.measure(),(f??=new Set).add(_));for(v=0;v<s;v+=1){if(h=t[v],g=a(h,v),_=c.get(g).e,e.outrogroups!==null)for(let t of e.outrogroups)t.pending.delete(_),t.done.delete(_);if(_.f&8192&&(Pn(_),o&&(_.nodes?.a?.unfix(),(f??=new Set).delete(_))),_.f&33554432){if(_.f^=E,_===l)Qr(_,null,n);else{var y=d?d.next:l;_===e.effect.last&&(e.effect.last=_.prev),_.prev&&(_.prev.next=_.next),_.next&&(_.next.prev=_.prev),$r(e,d,_),$r(e,_,y),Qr(_,y,n),d=_,p=[],m=[],l=Yr(d.next);continue}}if(_!==l){if(u!==void 0&&u.has(_)){if(p.length<m.length){var b=m[0],x;d=b.prev;var S=p[0],C=p[p.length-1];for(x=0;x<p.length;x+=1)Qr(p[x],b,n);for(x=0;x<m.length;x+=1)u.delete(m[x]);$r(e,S.prev,C.next),$r(e,d,S),$r(e,C,b),l=b,d=C,--v,p=[],m=[]}else u.delete(_),Qr(_,l,n),$r(e,_.prev,_.next),$r(e,_,d===null?e.effect.first:d.next),$r(e,d,_),d=_;continue}for(p=[],m=[];l!==null&&l!==_;)(u??=new Set).add(l),m.push(l),l=Yr(l.next);if(l===null)continue}_.f&33554432||p.push(_),d=_,l=Yr(_.next)}if(e.outrogroups!==null){for(let t of e.outrogroups)t.pending.size===0&&(qr(e,r(t.done)),e.outrogroups?.delete(t));e.outrogroups.size===0&&(e.outrogroups=null)}if(l!==null||u!==void 0){var w=[];if(u!==void 0)for(_ of u)_.f&8192||w.push(_);for(;l!==null;)!(l.f&8192)&&l!==e.fallback&&w.push(l),l=Yr(l.next);var T=w.length;if(T>0){var D=i&4&&s===0?n:null;if(o){for(v=0;v<T;v+=1)w[v].nodes?.a?.measure();for(v=0;v<T;v+=1)w[v].nodes?.a?.fix()}Kr(e,w,D)}}o&&qe(()=>{if(f!==void 0)for(_ of f)_.nodes?.a?.apply()})}function Zr(e,t,n,r,i,a,o,s){var c=o&1?o&16?zt(n):Bt(n,!1,!1):null,l=o&2?zt(i):null;return{v:c,i:l,e:Tn(()=>(a(t,c??n,l??i,s),()=>{e.delete(r)}))}}function Qr(e,t,n){if(e.nodes)for(var r=e.nodes.start,i=e.nodes.end,a=t&&!(t.f&33554432)?t.nodes.start:n;r!==null;){var o=an(r);if(a.before(r),r===i)return;r=o}}function $r(e,t,n){t===null?e.effect.first=n:t.next=n,n===null?e.effect.last=t:n.prev=t}function ei(e,t,...n){var r=new Hr(e);wn(()=>{let e=t()??null;r.ensure(e,e&&(t=>e(t,...n)))},S)}function ti(e,t,n){var r;ve&&(r=be,Se());var i=new Hr(e);wn(()=>{var e=t()??null;if(ve&&Te(r)===`[`!=(e!==null)){var a=we();xe(a),i.anchor=a,ye(!1),i.ensure(e,e&&(t=>n(t,e))),ye(!0)}else i.ensure(e,e&&(t=>n(t,e)))},S)}function ni(e,t){let n=null,r=ve;var i;if(ve){n=be;for(var a=rn(document.head);a!==null&&(a.nodeType!==8||a.data!==e);)a=an(a);if(a===null)ye(!1);else{var o=an(a);a.remove(),xe(o)}}ve||(i=document.head.appendChild(nn()));try{wn(()=>{var e=Tn(()=>t(i));e.f|=C,ve||(e.nodes===null?e.nodes={start:i,end:i,a:null,t:null}:e.nodes.end=i)})}finally{r&&(ye(!0),xe(n))}}function ri(e,t,n){bn(()=>{var r=fr(()=>t(e,n?.())||{});if(n&&r?.update){var i=!1,a={};Sn(()=>{var e=n();pr(e),i&&De(a,e)&&(a=e,r.update(e))}),i=!0}if(r?.destroy)return()=>r.destroy()})}function ii(e){var t,n,r=``;if(typeof e==`string`||typeof e==`number`)r+=e;else if(typeof e==`object`){if(Array.isArray(e)){var i=e.length;for(t=0;t<i;t++)e[t]&&(n=ii(e[t]))&&(r&&(r+=` `),r+=n)}else for(n in e)e[n]&&(r&&(r+=` `),r+=n)}return r}function ai(){for(var e,t,n=0,r=``,i=arguments.length;n<i;n++)(e=arguments[n])&&(t=ii(e))&&(r&&(r+=` `),r+=t);return r}function oi(e){return typeof e==`object`?ai(e):e??``}var si=[...` 	
\r\f\xA0\v﻿`];function ci(e,t,n){var r=e==null?``:``+e;if(t&&(r=r?r+` `+t:t),n){for(var i of Object.keys(n))if(n[i])r=r?r+` `+i:i;else if(r.length)for(var a=i.length,o=0;(o=r.indexOf(i,o))>=0;){var s=o+a;(o===0||si.includes(r[o-1]))&&(s===r.length||si.includes(r[s]))?r=(o===0?``:r.substring(0,o))+r.substring(s+1):o=s}}return r===``?null:r}function li(e,t=!1){var n=t?` !important;`:`;`,r=``;for(var i of Object.keys(e)){var a=e[i];a!=null&&a!==``&&(r+=` `+i+`: `+a+n)}return r}function ui(e){return e[0]!==`-`||e[1]!==`-`?e.toLowerCase():e}function di(e,t){if(t){var n=``,r,i;if(Array.isArray(t)?(r=t[0],i=t[1]):r=t,e){e=String(e).replaceAll(/\/\*.*?\*\//g,``).trim();var a=!1,o=0,s=!1,c=[];r&&c.push(...Object.keys(r).map(ui)),i&&c.push(...Object.keys(i).map(ui));var l=0,u=-1;let t=e.length;for(var d=0;d<t;d++){var f=e[d];if(s?f===`/`&&e[d-1]===`*`&&(s=!1):a?a===f&&(a=!1):f===`/`&&e[d+1]===`*`?s=!0:f===`"`||f===`'`?a=f:f===`(`?o++:f===`)`&&o--,!s&&a===!1&&o===0){if(f===`:`&&u===-1)u=d;else if(f===`;`||d===t-1){if(u!==-1){var p=ui(e.substring(l,u).trim());if(!c.includes(p)){f!==`;`&&d++;var m=e.substring(l,d).trim();n+=` `+m+`;`}}l=d+1,u=-1}}}}return r&&(n+=li(r)),i&&(n+=li(i,!0)),n=n.trim(),n===``?null:n}return e==null?null:String(e)}function fi(e,t,n,r,i,a){var o=e[ae];if(ve||o!==n||o===void 0){var s=ci(n,r,a);ve&&s===e.getAttribute(`class`)||(s==null?e.removeAttribute(`class`):t?e.className=s:e.setAttribute(`class`,s)),e[ae]=n}else if(a&&i!==a)for(var c in a){var l=!!a[c];(i==null||l!==!!i[c])&&e.classList.toggle(c,l)}return a}function pi(e,t={},n,r){for(var i in n){var a=n[i];t[i]!==a&&(n[i]==null?e.style.removeProperty(i):e.style.setProperty(i,a,r))}}function mi(e,t,n,r){var i=e[oe];if(ve||i!==t){var a=di(t,r);ve&&a===e.getAttribute(`style`)||(a==null?e.removeAttribute(`style`):e.style.cssText=a),e[oe]=t}else r&&(Array.isArray(r)?(pi(e,n?.[0],r[0]),pi(e,n?.[1],r[1],`important`)):pi(e,n,r));return r}function hi(e,t){t?e.hasAttribute(`selected`)||e.setAttribute(`selected`,``):e.removeAttribute(`selected`)}function gi(t,n){var r=t.__defaultValue,i=t.multiple,a=i?r??[]:null;if(!i||e(a)){var o=t.selectedIndex,s=n&&i?new Set(t.selectedOptions):null;for(var c of t.options){var l=bi(c);hi(c,i?a.includes(l):Yt(l,r))}if(n){if(s!==null)for(c of t.options){var u=s.has(c);c.selected!==u&&(c.selected=u)}else t.selectedIndex!==o&&(t.selectedIndex=o)}}}function _i(t,n,r=!1){if(t.multiple){if(n==null)return;if(!e(n))return ge();for(var i of t.options)i.selected=n.includes(bi(i))}else{for(i of t.options)if(Yt(bi(i),n)){i.selected=!0;return}r&&n===void 0||(t.selectedIndex=-1)}}function vi(e){var t=new MutationObserver(t=>{t.every(xi)||(`__defaultValue`in e&&gi(e,!1),`__value`in e&&_i(e,e.__value))});t.observe(e,{childList:!0,subtree:!0,attributes:!0,attributeFilter:[`value`]}),gn(()=>{t.disconnect()})}function yi(e,t,n=t){var r=new WeakSet,i=!0;rt(e,`change`,t=>{var i=t?`[selected]`:`:checked`,a;if(e.multiple)a=[].map.call(e.querySelectorAll(i),bi);else{var o=e.querySelector(i)??e.querySelector(`option:not([disabled])`);a=o&&bi(o)}n(a),e.__value=a,vt!==null&&r.add(vt)}),bn(()=>{var a=t();if(e===document.activeElement){var o=vt;if(r.has(o))return}if(_i(e,a,i),i&&a===void 0){var s=e.querySelector(`:checked`);s!==null&&(a=bi(s),n(a))}e.__value=a,i=!1})}function bi(e){return`__value`in e?e.__value:e.value}function xi(e){if(e.target.closest(`selectedcontent`)!==null)return!0;if(e.type===`childList`){var t=[...e.addedNodes,...e.removedNodes];return t.length>0&&t.every(e=>e.nodeName===`SELECTEDCONTENT`)}return!1}var Si=Symbol(`is custom element`),Ci=Symbol(`is html`),wi=ue?`link`:`LINK`,Ti=ue?`progress`:`PROGRESS`;function Ei(e){if(ve){var t=!1,n=()=>{if(!t){if(t=!0,e.hasAttribute(`value`)){var n=e.value;J(e,`value`,null),e.value=n}if(e.hasAttribute(`checked`)){var r=e.checked;J(e,`checked`,null),e.checked=r}}};e[ce]=n,qe(n),tt()}}function Di(e,t){var n=Oi(e);n.value!==(n.value=t??void 0)&&(e.value!==t||t===0&&e.nodeName===Ti)&&(e.value=t??``)}function J(e,t,n,r){var i=Oi(e);if(!(ve&&(i[t]=e.getAttribute(t),t===`src`||t===`srcset`||t===`href`&&e.nodeName===wi))){var a=i[t];a!==(i[t]=n)&&(t===`loading`&&(e[re]=n),n==null?e.removeAttribute(t):typeof n!=`string`&&Ai(e).has(t)?e[t]=n:(!ve||typeof n!=`number`&&typeof n!=`boolean`||a!==String(n))&&e.setAttribute(t,n))}}function Oi(e){return e[ie]??={[Si]:e.nodeName.includes(`-`),[Ci]:e.namespaceURI===pe}}var ki=new Map;function Ai(e){var t=e.getAttribute(`is`)||e.nodeName,n=ki.get(t);if(n)return n;ki.set(t,n=new Set);for(var r,i=e,a=Element.prototype;a!==i;){for(var s in r=o(i),r)r[s].set&&s!==`innerHTML`&&s!==`textContent`&&s!==`innerText`&&n.add(s);i=l(i)}return n}function ji(e,t,n=t){var r=new WeakSet;rt(e,`input`,async i=>{var a=i?e.defaultValue:e.value;if(a=Ni(e)?Pi(a):a,n(a),vt!==null&&r.add(vt),await lr(),a!==(a=t())){var o=e.selectionStart,s=e.selectionEnd,c=e.value.length;if(e.value=a??``,s!==null){var l=e.value.length;o===s&&s===c&&l>c?(e.selectionStart=l,e.selectionEnd=l):(e.selectionStart=o,e.selectionEnd=Math.min(s,l))}}}),(ve&&e.defaultValue!==e.value||fr(t)==null&&e.value)&&(n(Ni(e)?Pi(e.value):e.value),vt!==null&&r.add(vt)),Sn(()=>{var n=t();if(e===document.activeElement){var i=vt;if(r.has(i))return}Ni(e)&&n===Pi(e.value)||(e.type!==`date`||n||e.value)&&n!==e.value&&(e.value=n??``)})}function Mi(e,t,n=t){rt(e,`change`,t=>{n(t?e.defaultChecked:e.checked)}),(ve&&e.defaultChecked!==e.checked||fr(t)==null)&&n(e.checked),Sn(()=>{e.checked=!!t()})}function Ni(e){var t=e.type;return t===`number`||t===`range`}function Pi(e){return e===``?null:+e}function Fi(e,t){return e===t||e?.[k]===t}function Ii(e=Ue(),t,n,r){var i=ze.r,a=Un;return bn(()=>{var o,s;return Sn(()=>{o=s,s=r?.()||[],fr(()=>{Fi(n(...s),e)||(t(e,...s),o&&Fi(n(...o),e)&&t(null,...o))})}),()=>{let r=a;for(;r!==i&&r.parent!==null&&r.parent.f&33554432;)r=r.parent;let o=()=>{s&&Fi(n(...s),e)&&t(null,...s)},c=r.teardown;r.teardown=()=>{o(),c?.()}}}),e}var Li=!1;function Ri(e){var t=Li;try{return Li=!1,[e(),Li]}finally{Li=t}}function zi(e,t,n,r){var i=!0,o=!!(n&8),s=!!(n&16),c=r,l=!0,u=void 0,d=()=>s&&i?(u??=ct(r),V(u)):(l&&(l=!1,c=s?fr(r):r),c);let f;if(o){var p=k in e||ne in e;f=a(e,t)?.set??(p&&t in e?n=>e[t]=n:void 0)}var m,h=!1;o?[m,h]=Ri(()=>e[t]):m=e[t],m===void 0&&r!==void 0&&(m=d(),f&&(i&&Pe(t),f(m)));var g=i?()=>{var n=e[t];return n===void 0?d():(l=!0,n)}:()=>{var n=e[t];return n!==void 0&&(c=void 0),n===void 0?c:n};if(i&&!(n&4))return g;if(f){var _=e.$$legacy;return(function(e,t){return arguments.length>0?((!i||!t||_||h)&&f(t?g():e),e):g()})}var v=!1,y=(n&1?ct:dt)(()=>(v=!1,g()));o&&V(y);var b=Un;return(function(e,t){if(arguments.length>0){let n=t?V(y):i&&o?qt(e):e;return F(y,n),v=!0,c!==void 0&&(c=n),e}return Rn&&v||b.f&16384?y.v:V(y)})}function Bi(e){ze===null&&Oe(`onMount`),_n(()=>{let t=fr(e);if(typeof t==`function`)return t})}typeof window<`u`&&((window.__svelte??={}).v??=new Set).add(`5`);var Vi=[`inspect`,`plan`,`history`,`runs`,`do`],Hi=[`part`,`rev`,`op`,`from`,`to`,`run`,`t`,`act`];function Ui(e){let[t=``,n=``]=e.replace(/^#\/?/,``).split(`?`),[r,i,a]=t.split(`/`).map(decodeURIComponent),o=new URLSearchParams(n),s={};for(let e of Hi)o.get(e)&&(s[e]=o.get(e));return{bench:r&&i?`${r}/${i}`:null,tab:Vi.find(e=>e===a)??`inspect`,query:s}}function Wi(e){let t=new URLSearchParams(Object.entries(e.query).filter(([,e])=>e)).toString();return e.bench?`#/${e.bench}/${e.tab}${t?`?${t}`:``}`:`#/`}var Gi=new class{#e=P(qt(Ui(location.hash)));get now(){return V(this.#e)}set now(e){F(this.#e,e,!0)}constructor(){addEventListener(`hashchange`,()=>this.now=Ui(location.hash))}go(e,t={}){this.#t({...this.now,tab:e,query:{...this.now.query,...t}})}open(e){this.#t({...this.now,bench:e})}set(e){let t={...this.now.query};for(let[n,r]of Object.entries(e))r?t[n]=r:delete t[n];this.#t({...this.now,query:t})}#t(e){this.now=e,history.replaceState(null,``,`${location.pathname}${location.search}${Wi(e)}`)}},Ki=class extends Error{status;diagnostics;constructor(e,t){super(t.map(e=>e.summary).join(`; `)||`the coordinator answered ${e}`),this.status=e,this.diagnostics=t}};function qi(e){return e.source?`${e.source.path}:${e.source.start.line}:${e.source.start.column}: ${e.summary}`:e.summary}function Ji(e,t={}){let n=new URLSearchParams,r=e;for(let[e,i]of Object.entries(t)){let t=`{${e}}`;r.includes(t)?r=r.replace(t,encodeURIComponent(i)):n.set(e,String(i))}return n.size?`${r}?${n}`:r}async function Yi(e,t,n,r){let i={method:e.toUpperCase(),credentials:`same-origin`,signal:r??null};n!==void 0&&(i.body=JSON.stringify(n),i.headers={"content-type":`application/json`});let a;try{a=await fetch(t,i)}catch(e){throw r?.aborted?e:new Ki(0,[{severity:`error`,code:`away`,summary:`the coordinator does not answer`,hint:`is it still served?`}])}if(a.ok)return a;let o=await a.json().catch(()=>null);throw new Ki(a.status,o?.error??[])}async function Xi(e,t,n={},r,i){let a=await Yi(e,Ji(t,n),r,i);return a.status===204?null:await a.json()}async function*Zi(e,t,n,r={}){let i=await Yi(e,t,n,r.signal),a=i.headers.get(`x-pico-run`);a&&r.begun?.(a),yield*$i(i.body)}function Qi(e){return e instanceof DOMException&&e.name===`AbortError`?e:new Ki(0,[{severity:`error`,code:`away`,summary:`the coordinator was lost in the middle of its answer`,hint:`what was begun may go on: Runs tells once it is back`}])}async function*$i(e){let t=e.getReader(),n=new TextDecoder,r=``;try{for(;;){let{value:e,done:i}=await t.read().catch(e=>{throw Qi(e)});r+=n.decode(e,{stream:!i});let a=r.split(`
`);r=a.pop();for(let e of a)e.trim()&&(yield JSON.parse(e));if(i)break}r.trim()&&(yield JSON.parse(r))}finally{await t.cancel().catch(()=>void 0)}}function ea(e){let t=new DataView(e),n=0,r=()=>t.getUint8(n++),i=()=>t.getUint16((n+=2)-2,!0),a=()=>t.getUint32((n+=4)-4,!0),o=()=>t.getFloat32((n+=4)-4,!0),s=()=>t.getFloat64((n+=8)-8,!0),c=r();if(c!==1)throw RangeError(`a frame of version ${c}, and this page reads version 1`);let l={epoch:a(),rev:a(),time:s(),arms:[],bodies:[]};for(let e=r();e>0;e--){let e=r(),t=Float32Array.from({length:r()},o);l.arms.push({index:e,joints:t,gripper:o()})}for(let e=i();e>0;e--){let e=i();l.bodies.push({index:e,position:[o(),o(),o()],quaternion:[o(),o(),o(),o()]})}if(n!==e.byteLength)throw RangeError(`${e.byteLength-n} bytes too many in a frame`);return l}var ta=[200,500,1e3,2e3],na=class{path;hears;#e=null;#t=0;#n=0;#r=!1;constructor(e,t){this.path=e,this.hears=t,t.state(`opening`),this.#i()}close(){this.#r=!0,clearTimeout(this.#n),this.#e?.close()}#i(){let e=this.#e=new WebSocket(new URL(this.path,location.href.replace(/^http/,`ws`)));e.binaryType=`arraybuffer`,e.onopen=()=>{this.#t=0,this.hears.state(`open`),this.hears.opened()},e.onmessage=({data:e})=>{typeof e==`string`?this.hears.text(JSON.parse(e)):this.hears.binary(e)},e.onclose=()=>{this.#r||(this.hears.state(`lost`),this.#n=window.setTimeout(()=>this.#i(),ta[Math.min(this.#t++,ta.length-1)]))}}};function ra(e){let t=e;if(t.schema!==`pico.scene/v1`)throw RangeError(`the bench speaks ${String(t.schema)}, and this page reads pico.scene/v1`);return t}function ia(e,t){if(t.kind===`beams`)return{...e,rev:t.rev,beams:t.data.beams};if(t.kind===`guard`)return{...e,rev:t.rev,guard:t.data.notices};if(t.kind!==`component`)return e;let n=t.data,r=e.components.some(e=>e.index===n.index)?e.components.map(e=>e.index===n.index?{...e,...n}:e):[...e.components,n];return{...e,rev:t.rev,components:r}}var aa=new class{#e=P(null);get me(){return V(this.#e)}set me(e){F(this.#e,e,!0)}#t=P(qt([]));get benches(){return V(this.#t)}set benches(e){F(this.#t,e,!0)}#n=P(`asking`);get state(){return V(this.#n)}set state(e){F(this.#n,e,!0)}#r=P(qt([]));get trouble(){return V(this.#r)}set trouble(e){F(this.#r,e,!0)}async begin(){let e=/^#code=([\w.-]+)$/.exec(location.hash)?.[1];e?(history.replaceState(null,``,location.pathname+location.search),Gi.now={...Gi.now,bench:null},await this.enter({code:e})):await this.#i()}async enter(e){try{await Xi(`post`,`/api/session`,{},e),await this.#i()}catch(e){this.#a(e)}}async leave(){await Xi(`delete`,`/api/session`).catch(()=>void 0),this.me=null,this.state=`out`}async#i(){try{this.me=await Xi(`get`,`/api/whoami`),this.benches=await Xi(`get`,`/api/benches`),this.trouble=[],this.state=`in`;let e=this.benches[0];e&&!this.benches.some(e=>e.bench===Gi.now.bench)&&Gi.open(e.bench)}catch(e){this.#a(e)}}#a(e){if(this.state=`out`,!(e instanceof Ki))throw e;this.trouble=e.status===401&&!e.diagnostics[0]?.code.includes(`code`)?[]:e.diagnostics}may(e,t){let n={viewer:[`viewer`,`operator`,`admin`],operator:[`operator`,`admin`]}[e]??[e];return(this.me?.rights??[]).some(e=>{let[r=``,i=`*`]=e.split(`@`);return n.includes(r)&&(i===`*`||i===t)})}},oa=new class{#e=P(qt([]));get all(){return V(this.#e)}set all(e){F(this.#e,e,!0)}#t=0;say(e,t=6){let n=this.#n(`said`,e,``);setTimeout(()=>this.drop(n),t*1e3)}wrong(e){for(let t of e)this.#n(`wrong`,qi(t),t.hint??``)}failed(e){if(e instanceof Ki)this.wrong(e.diagnostics.length?e.diagnostics:[{severity:`error`,code:``,summary:e.message}]);else if(!(e instanceof DOMException&&e.name===`AbortError`))throw e}async trying(e){try{await e()}catch(e){this.failed(e)}}drop(e){this.all=this.all.filter(t=>t.number!==e)}#n(e,t,n){let r=this.all.find(e=>e.text===t);if(r)return r.number;let i=++this.#t;return this.all=[...this.all,{number:i,kind:e,text:t,hint:n}].slice(-4),i}},sa=`page-${sessionStorage.getItem(`pico-session`)??ca()}`;function ca(){let e=Array.from(crypto.getRandomValues(new Uint8Array(6)),e=>e.toString(16).padStart(2,`0`)).join(``);return sessionStorage.setItem(`pico-session`,e),e}var la=`pico-asked`,ua=10,da=5,Y=new class{#e=P(null);get name(){return V(this.#e)}set name(e){F(this.#e,e,!0)}#t=P(null);get scene(){return V(this.#t)}set scene(e){F(this.#t,e)}#n=P(`opening`);get line(){return V(this.#n)}set line(e){F(this.#n,e,!0)}#r=P(null);get lease(){return V(this.#r)}set lease(e){F(this.#r,e,!0)}#i=P(0);get asked(){return V(this.#i)}set asked(e){F(this.#i,e,!0)}#a=P(null);get token(){return V(this.#a)}set token(e){F(this.#a,e,!0)}#o=P(!1);get waits(){return V(this.#o)}set waits(e){F(this.#o,e,!0)}#s=P(!1);get turn(){return V(this.#s)}set turn(e){F(this.#s,e,!0)}#c=P(0);get begun(){return V(this.#c)}set begun(e){F(this.#c,e,!0)}onframe=()=>void 0;#l=new Set;#u=null;#d=null;#f=0;#p=0;#m=P(`here`);get edge(){return V(this.#m)}set edge(e){F(this.#m,e,!0)}session=sa;get mine(){return this.#h(this.lease?.holder??null)}#h(e){return e?.you===!0&&e.session.endsWith(`/${sa}`)}get runs(){let e=this.lease?.holder;return e?.you===!0&&e.session.includes(`/${sa}~`)}get lab(){return this.name?.split(`/`)[0]??``}get at(){let[e=``,t=``]=(this.name??``).split(`/`);return{lab:e,bench:t}}listen(e){return this.#l.add(e),()=>this.#l.delete(e)}open(e){this.close(),this.name=e;let t=Ji(`/api/benches/{lab}/{bench}/live`,this.at);this.#u=new na(t,{opened:()=>void 0,text:e=>this.#_(e),binary:e=>this.#v(e),state:e=>this.line=e}),this.#d=new na(`/api/events`,{opened:()=>void this.look(),text:e=>{let t=e;t.bench===this.name&&(t.kind===`desk`&&t.data?.session!==sa&&this.begun++,this.look())},binary:()=>void 0,state:()=>void 0})}close(){this.#u?.close(),this.#d?.close(),clearInterval(this.#f),this.scene=this.lease=this.token=null}async#g(){try{this.scene=ra(await Xi(`get`,`/api/benches/{lab}/{bench}/scene`,this.at)),this.edge=`here`}catch(e){e instanceof Ki&&e.status>=500?this.edge=`away`:oa.failed(e)}}#_(e){if(`hello`in e){this.#p=e.hello.seq,e.hello.epoch===null&&(this.edge=`away`),this.#g();return}let t=e.seq!==this.#p+1;this.#p=e.seq,e.kind===`away`?this.edge=`away`:e.kind===`lease`?this.look():t||e.kind===`scene`||e.epoch!==this.scene?.epoch?this.#g():e.rev>this.scene.rev&&(this.scene=ia(this.scene,e)),e.kind===`guard`&&oa.wrong(e.data.notices);for(let t of this.#l)t(e)}#v(e){let t=ea(e);this.scene&&t.epoch===this.scene.epoch&&this.onframe(t)}async look(){try{this.lease=await Xi(`get`,`/api/benches/{lab}/{bench}/lease`,this.at),this.asked=performance.now(),this.#y(this.lease.holder)}catch(e){e instanceof Ki&&e.status===0||oa.failed(e)}}#y(e){if(this.token===null&&sessionStorage.getItem(la)===this.name&&e&&this.#h(e)){if(!e.fenced)return void setTimeout(()=>void this.look(),300);this.turn=this.waits,this.turn&&oa.say(`It is your turn: you have ${this.name}.`,60),this.#x(e.token,ua)}}async take(){sessionStorage.setItem(la,this.name??``),await oa.trying(async()=>{let e=await Xi(`post`,`/api/benches/{lab}/{bench}/lease`,this.at,{session:sa,wait:2});e.token===void 0?(this.waits=!0,oa.say(`Asked for: you are told when it is your turn.`)):this.#x(e.token,e.lasts)}),await this.look()}async release(){this.#b(),await oa.trying(()=>Xi(`delete`,`/api/benches/{lab}/{bench}/lease`,{...this.at,session:sa,token:this.token??0})),this.token=null,await this.look()}async steal(e){sessionStorage.setItem(la,this.name??``),await oa.trying(async()=>{let t=await Xi(`post`,`/api/benches/{lab}/{bench}/lease/steal`,this.at,{session:sa,reason:e});this.#x(t.token,t.lasts)}),await this.look()}#b(){clearInterval(this.#f),sessionStorage.removeItem(la),this.waits=this.turn=!1}#x(e,t){this.token=e,this.waits=!1,clearInterval(this.#f),this.#f=window.setInterval(async()=>{try{await Xi(`put`,`/api/benches/{lab}/{bench}/lease`,this.at,{session:sa,token:e})}catch(e){if(e instanceof Ki&&e.status===0)return;this.#b(),this.token=null,oa.failed(e)}await this.look()},t*1e3/3)}async stop(){try{await Xi(`post`,`/api/benches/{lab}/{bench}/calls/stop`,this.at,{with:[]},AbortSignal.timeout(da*1e3)),oa.say(`Stopped: arms brake, shutters close, grippers hold.`)}catch(e){let t=e instanceof Ki?e.message:`no answer within ${da} s`;oa.wrong([{severity:`error`,code:`stop`,summary:`Not known to have stopped: ${t}`,hint:`use the emergency stop beside the table`}])}}async halt(){await oa.trying(()=>Xi(`post`,`/api/benches/{lab}/{bench}/calls/halt`,this.at,{with:[]}))}get barred(){if(!this.name)return`no bench is chosen`;if(!aa.may(`operator`,this.lab))return`you may watch here; moving needs the role operator`;if(this.line===`lost`)return`the line to the coordinator is lost`;if(this.edge===`away`)return`the bench's edge is not connected`;let e=this.lease?.holder;return e&&!e.you?`${e.who} has the bench`:e&&!this.mine?e.run||this.runs?`a run of yours goes on`:`you have the bench in another page or terminal`:null}};function fa(e,t){let n={...ra(e.scene),epoch:t},r=new Map(n.arms.map(e=>[e.index,[{time:0,values:[...e.joints,e.width]}]])),i=new Map;for(let e of n.components)e.position&&e.quaternion&&i.set(e.index,[{time:0,values:[...e.position,...e.quaternion]}]);for(let t of e.moved){for(let[e,n,i]of t.arms)pa(r,e,{time:t.time,values:[...n,i]});for(let[e=-1,...n]of t.bodies)pa(i,e,{time:t.time,values:n})}let a=[{time:0,scene:n}];for(let t of e.told){let e=a.at(-1),n=ia(e.scene,t);t.time===e.time?e.scene=n:a.push({time:t.time,scene:n})}return{frames:e,arms:r,bodies:i,scenes:a}}function pa(e,t,n){let r=e.get(t);r?r.push(n):e.set(t,[n])}function ma(e,t){let n=0,r=e.length;for(;n<r;){let i=n+r>>1;e[i].time<=t?n=i+1:r=i}return n-1}function ha(e,t){let n=Math.max(0,ma(e,t)),r=e[n],i=e[n+1];return!i||t<=r.time?{a:r.values,b:r.values,share:0}:{a:r.values,b:i.values,share:(t-r.time)/(i.time-r.time)}}function ga(e,t,n){return Array.from({length:e.length},(r,i)=>e[i]+n*(t[i]-e[i]))}function _a(e,t,n){let[r=1,i=0,a=0,o=0]=ga(e,e[0]*t[0]+e[1]*t[1]+e[2]*t[2]+e[3]*t[3]<0?Array.from(t,e=>-e):t,n),s=Math.hypot(r,i,a,o)||1;return[r/s,i/s,a/s,o/s]}function va(e,t){let n=[],r=[];for(let[r,i]of e.arms){let{a:e,b:a,share:o}=ha(i,t),s=ga(e,a,o);n.push({index:r,joints:Float32Array.from(s.slice(0,-1)),gripper:s.at(-1)})}for(let[n,i]of e.bodies){let{a:e,b:a,share:o}=ha(i,t),[s=0,c=0,l=0]=ga(e,a,o);r.push({index:n,position:[s,c,l],quaternion:_a(e.slice(3),a.slice(3),o)})}let{scene:i}=e.scenes[0];return{epoch:i.epoch,rev:0,time:t,arms:n,bodies:r}}function ya(e,t){return e.scenes[Math.max(0,ma(e.scenes,t))].scene}function ba(e,t){return e.steps.filter(e=>e.start<=t&&t<e.start+Math.max(e.seconds,.001))}function xa(e,t,n){return e.phases.filter(([e,r])=>r===t&&e<=n).at(-1)?.[2]??``}function Sa(e){return[...new Set([0,...e.steps.map(e=>e.start),e.seconds])].sort((e,t)=>e-t)}function Ca(e,t,n){let r=Sa(e);return n>0?r.find(e=>e>t+.001)??e.seconds:r.filter(e=>e<t-.001).at(-1)??0}function wa(e,t){let n=e.steps.find(e=>e.operation===t);if(!n)return null;let r=n.start+n.seconds,i=e.phases.filter(([e,t])=>t===n.robot&&e>=n.start-.001&&e<r),a=i.findIndex(([,,e])=>e===`transit`);return a<0?r:(i[a][0]+(i[a+1]?.[0]??r))/2}function Ta(e,t,n){let r=va(e,t),i=e.scenes[0].scene,a=new Map(i.components.map(e=>[e.index,e.name])),o=new Map(n.components.map(e=>[e.name,e])),s=r.arms.flatMap(e=>{let t=i.arms.find(t=>t.index===e.index)?.name,r=n.arms.find(e=>e.name===t)?.index;return r===void 0?[]:[{...e,index:r}]}),c=r.bodies.flatMap(t=>{let n=o.get(a.get(t.index)??``);if(!n?.position)return[];let r=e.bodies.get(t.index)[0].values,i=Math.hypot(...t.position.map((e,t)=>e-r[t])),s=Math.abs(1-Math.abs(t.quaternion.reduce((e,t,n)=>e+t*r[n+3],0)));return i<.5&&s<1e-5?[]:[{...t,index:n.index}]});return{epoch:n.epoch,rev:n.rev,time:t,arms:s,bodies:c}}function Ea(e){let t=e.at(-1);return t&&`schema`in t&&t.schema===`pico.question/v1`?t:null}function Da(e){let[t,n=`-`]=e;return t!==`run`||n.startsWith(`-`)?``:n.replace(/^.*\//,``).replace(/\.yaml$/,``)}function Oa(e,t){let{"":n,by:r}=e.result??{};return[n===void 0?``:`${n}${t&&` ${t}`}`,r?`by ${r}`:``].filter(Boolean).join(`, `)}function ka(e){return e.split(`.`).length-1}function Aa(e){return e==null?``:typeof e==`string`?e:JSON.stringify(e)}function ja(e,t){return e.flatMap(({name:e,default:n})=>{let r=(t[e]??``).trim();return r&&r!==Aa(n)?[`-p`,`${e}=${r}`]:[]})}function Ma(e,t){return e.startsWith(t)&&/^[.[]/.test(e.slice(t.length))}function Na(e,t,n=!1){let r=new Map(e.map(({path:e,title:t})=>[e,{path:e,title:t,depth:ka(e),state:`waiting`,turn:``,said:``}])),i=new Map;for(let e of t){if(`schema`in e&&e.schema===`pico.question/v1`&&i.set(String(e.path),String(e.unit)),!(`schema`in e)||e.schema!==`pico.recipe_event/v1`)continue;let t=e;if(t.path.endsWith(`?`))continue;let n=r.get(t.path)??{path:t.path,title:t.title??``,depth:ka(t.path),state:`waiting`,turn:``,said:``};if(r.set(t.path,n),t.event===`step`)for(let e of r.values())e.state===`going`&&!Ma(t.path,e.path)&&(e.state=`done`);t.event===`step`?Object.assign(n,{state:`going`,title:t.title??n.title,turn:t.turns?`${t.turn} of ${t.turns}`:``}):(n.state=t.before?`before`:`done`,n.said=Oa(t,i.get(t.path)??``)||n.said)}if(n)for(let e of r.values())e.state===`going`&&(e.state=`done`);return[...r.values()]}var Pa=`pico-run`;function Fa(){return{words:[],run:null,who:null,plan:null,events:[],said:[],steps:{},report:null,exit:null,diagnostics:[]}}var Ia=class{#e=P(null);get status(){return V(this.#e)}set status(e){F(this.#e,e)}#t=P(null);get plan(){return V(this.#t)}set plan(e){F(this.#t,e)}#n=P(null);get ahead(){return V(this.#n)}set ahead(e){F(this.#n,e)}#r=P(!1);get thinking(){return V(this.#r)}set thinking(e){F(this.#r,e,!0)}#i=0;#a=P(qt([]));get planned(){return V(this.#a)}set planned(e){F(this.#a,e,!0)}#o=P(null);get log(){return V(this.#o)}set log(e){F(this.#o,e)}#s=P(null);get diff(){return V(this.#s)}set diff(e){F(this.#s,e)}#c=P([]);get runs(){return V(this.#c)}set runs(e){F(this.#c,e)}#l=P([]);get others(){return V(this.#l)}set others(e){F(this.#l,e)}#u=P([]);get lasers(){return V(this.#u)}set lasers(e){F(this.#u,e)}#d=P(null);get going(){return V(this.#d)}set going(e){F(this.#d,e,!0)}#f=P(qt([]));get refused(){return V(this.#f)}set refused(e){F(this.#f,e,!0)}#p=P(``);#m=P(``);get patch(){return V(this.#m)}set patch(e){F(this.#m,e,!0)}#h=P(qt([]));get busy(){return V(this.#h)}set busy(e){F(this.#h,e,!0)}async run(e,t=()=>void 0,n=()=>void 0){let{path:r,rest:i}=za(e),a={said:[],exit:1,diagnostics:[]},o=e.join(` `);this.busy=[...this.busy,o];try{let e={words:i,session:Y.session,bench:Y.at.bench};for await(let i of Zi(`post`,Ji(r,{lab:Y.lab}),e,{begun:n}))if(`exit`in i&&!(`schema`in i))a.exit=i.exit;else{a.said.push(i);let e=i.diagnostics;e&&a.diagnostics.push(...e),t(i)}}catch(e){if(!(e instanceof Ki))throw e;a.diagnostics.push(...e.diagnostics)}finally{let e=this.busy.indexOf(o);this.busy=this.busy.filter((t,n)=>n!==e)}return a}async read(e,...t){let n=await this.run(t),r=n.said.find(t=>`schema`in t&&t.schema===e);return r||oa.wrong(n.diagnostics.filter(e=>e.severity===`error`)),r??null}async look(){this.status=await this.read(`pico.status/v1`,`status`)??this.status}async history(){this.log=await this.read(`pico.log/v1`,`log`,`--graph`,`--all`)??this.log}async recorded(){let e=await this.read(`pico.runs/v1`,`runs`,`list`,`--all`,`--others`);e&&(this.runs=e.runs.map(e=>e.document),this.others=e.others.map(e=>e.document))}async lit(){this.lasers=(await this.read(`pico.lasers/v1`,`laser`))?.lasers??this.lasers}async compare(e,t){this.diff=await this.read(`pico.diff/v1`,`diff`,e,t)}async show(e){return this.read(`pico.revision/v1`,`show`,e)}async think(e){this.planned=e,this.ahead=null,this.thinking=!0;let t=++this.#i,n=await this.run([...e,`--frames`],e=>{t===this.#i&&`schema`in e&&(e.schema===`pico.plan/v1`?(this.plan=e,this.thinking=!1):e.schema===`pico.frames/v1`&&(this.ahead=fa(e,0)))});t===this.#i&&(this.thinking=!1,n.said.some(e=>`schema`in e&&e.schema===`pico.plan/v1`)||(this.plan=null,oa.wrong(n.diagnostics.filter(e=>e.severity===`error`))))}async wrote(e){let t=await this.read(`pico.capture/v1`,...e);return t?(t.changes.length||oa.say(`The manifest says so already, within the tolerance.`),this.patch=t.patch,await this.look(),!0):!1}async did(e){let t=await this.run(e);return oa.wrong(t.diagnostics.filter(e=>e.severity===`error`)),this.patch=``,await Promise.all([this.look(),this.history(),...e[0]===`laser`?[this.lit()]:[]]),t.exit===0}get question(){let e=this.going&&this.going.exit===null?Ea(this.going.said):null;return e&&`${this.going?.run} ${e.id}`!==V(this.#p)?e:null}get mayAnswer(){if(!aa.may(`operator`,Y.lab))return`needs the role operator`;let e=this.going?.who??aa.me?.name;return e!==aa.me?.name&&!aa.may(`admin`,Y.lab)?`${e} began it, and answers it`:null}async answer(e){let t=this.going?.run,{question:n}=this;if(t&&n){this.refused=[];try{await Xi(`post`,`/api/labs/{lab}/desk/runs/{run}/answers`,{lab:Y.lab,run:t},{question:n.id,answer:e}),F(this.#p,`${t} ${n.id}`)}catch(e){if(!(e instanceof Ki))throw e;this.refused=e.diagnostics}}}async cancel(){let e=this.going?.run;e?await oa.trying(()=>Xi(`delete`,`/api/labs/{lab}/desk/runs/{run}`,{lab:Y.lab,run:e})):await Y.halt()}async follow(){if(this.going&&this.going.exit===null)return;let{runs:e}=await Xi(`get`,`/api/labs/{lab}/desk/runs`,{lab:Y.lab}),t=sessionStorage.getItem(Pa);sessionStorage.removeItem(Pa);let n=e.find(e=>e.id===t)??e.find(e=>e.exit===null&&[Y.name,Y.at.bench].includes(e.bench));if(!n||this.going&&this.going.exit===null)return;this.going={...Fa(),words:[...n.command.split(` `),...n.words],run:n.id,who:n.who};let r=this.going;try{for await(let e of Zi(`get`,Ji(`/api/labs/{lab}/desk/runs/{run}/events`,{lab:Y.lab,run:n.id})))`exit`in e&&!(`schema`in e)?r.exit=e.exit:(r.diagnostics.push(...e.diagnostics??[]),Ba(r,e))}finally{r.exit??=1}await Promise.all([this.look(),this.history(),this.recorded()])}async move(e){this.going={...Fa(),words:e};let t=this.going,n=await this.run(e,e=>Ba(t,e),e=>{t.run=e,sessionStorage.setItem(Pa,e)});return sessionStorage.removeItem(Pa),t.exit=n.exit,t.diagnostics=n.diagnostics,await Promise.all([this.look(),this.history(),this.recorded()]),n.exit}},La=[`catalog`,`git`,`laser`,`recipe`,`runs`,`sim`],Ra=[`laser`];function za(e){let[t=``,n=`-`]=e,r=La.includes(t)&&!(Ra.includes(t)&&n.startsWith(`-`))?2:1;return{path:`/api/labs/{lab}/desk/${e.slice(0,r).join(`/`)}`,rest:e.slice(r)}}function Ba(e,t){if(`schema`in t){if(t.schema===`pico.plan/v1`){e.plan=t;for(let t of e.plan.operations)e.steps[t.id]={state:`waiting`,fraction:0,phase:``}}else if(t.schema===`pico.report/v1`)e.report=t;else if(t.schema===`pico.event/v1`){let n=t;e.events.push(n);let r=n.operation?e.steps[n.operation]??={state:`waiting`,fraction:0,phase:``}:null;if(!r)return;n.kind===`operation_started`?Object.assign(r,{state:`going`,began:n.time}):n.kind===`operation_progress`?(r.fraction=Number(n.data.fraction??0),r.phase=String(n.data.phase??``),r.took=n.time-(r.began??n.time)):n.kind===`operation_done`?Object.assign(r,{state:`done`,fraction:1,phase:``}):n.kind===`operation_failed`?r.state=`failed`:n.kind===`operation_unknown`&&(r.state=`unknown`)}else e.said.push(t),t.schema===`pico.question/v1`&&(X.refused=[])}}var X=new Ia,Va=0,Ha=1e3,Ua=new class{#e=P(null);get film(){return V(this.#e)}set film(e){F(this.#e,e)}#t=P(0);get time(){return V(this.#t)}set time(e){F(this.#t,e,!0)}#n=P(!1);get playing(){return V(this.#n)}set playing(e){F(this.#n,e,!0)}#r=P(4);get speed(){return V(this.#r)}set speed(e){F(this.#r,e,!0)}#i=P(null);get opening(){return V(this.#i)}set opening(e){F(this.#i,e,!0)}#a=P(null);get of(){return V(this.#a)}set of(e){F(this.#a,e,!0)}#o=0;#s=0;get frames(){return this.film?.frames??null}#c=N(()=>this.film?ya(this.film,this.time):null);get scene(){return V(this.#c)}set scene(e){F(this.#c,e)}#l=N(()=>this.film?va(this.film,this.time):null);get frame(){return V(this.#l)}set frame(e){F(this.#l,e)}async open(e,t=0){if(this.opening===e)return;this.opening=this.of=e,this.playing=!1;let n=await X.read(`pico.frames/v1`,`runs`,`show`,e,`--frames`);if(this.opening===e){if(this.opening=null,!n)return this.close();this.film=fa(n,-++Va),this.seek(t)}}close(){this.film=this.opening=this.of=null,this.playing=!1,Gi.set({t:null})}seek(e){this.time=Math.max(0,Math.min(e,this.frames?.seconds??0)),this.#d()}step(e){this.frames&&(this.playing=!1,this.seek(Ca(this.frames,this.time,e)))}toggle(){this.frames&&(!this.playing&&this.time>=this.frames.seconds&&(this.time=0),this.playing=!this.playing,this.#o=performance.now(),this.playing?requestAnimationFrame(this.#u):this.#d())}#u=e=>{if(!this.playing||!this.frames)return;let t=this.time+this.speed*Math.max(0,e-this.#o)/1e3;this.#o=e,this.time=Math.min(t,this.frames.seconds),this.time>=this.frames.seconds&&(this.playing=!1),(!this.playing||e-this.#s>Ha)&&this.#d(e),this.playing&&requestAnimationFrame(this.#u)};#d(e=performance.now()){this.#s=e,this.frames&&Gi.set({t:this.time.toFixed(2)})}};function Wa(e){return e?.measurables??{}}function Ga(e){return e.filter(e=>Wa(e).image?.datatype===`image`)}function Ka(e){if(e.value===null)return[];if(typeof e.value==`number`)return[{name:``,value:e.value,sigma:typeof e.sigma==`number`?e.sigma:null,unit:e.unit}];let t=typeof e.sigma==`object`?e.sigma:null,n=e.unit.split(`, `);return Object.entries(e.value).map(([r,i],a)=>({name:r,value:i,sigma:t?.[r]??null,unit:n[a]??e.unit}))}function qa(e,t){if(!t||!Number.isFinite(t))return String(Number(e.toPrecision(5)));let n=Math.max(0,Math.min(8,1-Math.floor(Math.log10(t))));return`${e.toFixed(n)} ± ${t.toFixed(n)}`}var Ja=class{component;measurable;kernels;every;#e=P(null);get still(){return V(this.#e)}set still(e){F(this.#e,e)}#t=P(``);get why(){return V(this.#t)}set why(e){F(this.#t,e,!0)}#n=!1;constructor(e,t,n,r){this.component=e,this.measurable=t,this.kernels=n,this.every=r}begin(){return this.#n=!0,this.#r(),()=>{this.#n=!1}}async#r(){for(;this.#n;)!document.hidden&&Y.edge===`here`&&Y.line===`open`&&await this.#i(),await new Promise(e=>setTimeout(e,this.every))}async#i(){try{let{value:e}=await Xi(`post`,`/api/benches/{lab}/{bench}/calls/picture`,Y.at,{with:[this.component,this.measurable,this.kernels],session:Y.session});this.still=e,this.why=``}catch(e){if(!(e instanceof Ki))throw e;this.why=e.message}}},Ya=jr(`<path class="cross svelte-baybvi"></path>`),Xa=jr(`<rect class="box svelte-baybvi"></rect>`),Za=jr(`<ellipse class="ellipse svelte-baybvi"></ellipse>`),Qa=U(`<div class="picture svelte-baybvi"><img class="svelte-baybvi"/> <svg aria-hidden="true" class="svelte-baybvi"></svg></div>`);function $a(e,t){Ve(t,!0);var n=Qa(),r=I(n),i=z(r,2);q(i,21,()=>t.still.marks,Gr,(e,t)=>{var n=Nr(),r=L(n),i=e=>{var n=Ya();B(()=>J(n,`d`,`M${V(t).x-22} ${V(t).y??``} h44 M${V(t).x??``} ${V(t).y-22} v44`)),W(e,n)},a=e=>{var n=Xa();B(()=>{J(n,`x`,V(t).x),J(n,`y`,V(t).y),J(n,`width`,V(t).width),J(n,`height`,V(t).height)}),W(e,n)},o=e=>{var n=Za();B(()=>{J(n,`cx`,V(t).x),J(n,`cy`,V(t).y),J(n,`rx`,V(t).major),J(n,`ry`,V(t).minor),J(n,`transform`,`rotate(${V(t).angle??``} ${V(t).x??``} ${V(t).y??``})`)}),W(e,n)};K(r,e=>{V(t).mark===`cross`?e(i):V(t).mark===`box`?e(a,1):e(o,-1)}),W(e,n)}),A(i),A(n),B(()=>{J(r,`src`,`data:image/png;base64,${t.still.png??``}`),J(r,`alt`,t.alt),J(r,`width`,t.still.width),J(r,`height`,t.still.height),J(i,`viewBox`,`0 0 ${t.still.width??``} ${t.still.height??``}`)}),W(e,n),He()}var eo=U(`<span class="badge bad">saturated</span>`),to=U(`<span class="badge warn"> </span>`),no=U(`<p class="dim none svelte-104dwsb"> </p>`),ro=U(`<div class="tile svelte-104dwsb"><div class="head svelte-104dwsb"><button class="small bare mono" title="Measure with it"> </button><span class="grow"></span> <!><!> <button class="small bare">✕</button></div> <!></div>`),io=U(`<button class="small svelte-104dwsb"> </button>`),ao=U(`<aside aria-label="Cameras"><!> <div class="row pins svelte-104dwsb"><!> <button class="small svelte-104dwsb" title="Pin cameras beside the bench">Cameras</button></div></aside>`);function oo(e,t){Ve(t,!0);let n=N(()=>Ga(Y.scene?.components??[]).map(e=>e.name)),r=P(qt([])),i=P(!1),a=P([]),o=N(()=>V(r).filter(e=>V(n).includes(e)).join(`|`));_n(()=>{let e=V(o)?V(o).split(`|`).map(e=>new Ja(e,`image`,[`centroid`],1e3)):[];F(a,e);let t=e.map(e=>e.begin());return()=>{for(let e of t)e()}});function s(e){F(r,V(r).includes(e)?V(r).filter(t=>t!==e):[...V(r),e].slice(-3),!0)}var c=Nr(),l=L(c),u=e=>{var t=ao();let o;var c=I(t);q(c,17,()=>V(a),e=>e.component,(e,t)=>{var n=ro(),r=I(n),i=I(r),a=R(i,!0),o=z(i,3),c=e=>{W(e,eo())};K(o,e=>{V(t).still?.saturated&&e(c)});var l=z(o),u=e=>{var n=to(),r=R(n);B(e=>G(r,`${e??``} s old`),[()=>V(t).still.age.toFixed(0)]),W(e,n)};K(l,e=>{V(t).still?.waits&&e(u)});var d=z(l,2);A(r);var f=z(r,2),p=e=>{$a(e,{get still(){return V(t).still},get alt(){return`What ${V(t).component??``} sees`}})},m=e=>{var n=no(),r=R(n,!0);B(()=>G(r,V(t).why||`Looking …`)),W(e,n)};K(f,e=>{V(t).still?e(p):e(m,-1)}),A(n),B(()=>{G(a,V(t).component),J(d,`aria-label`,`Unpin ${V(t).component??``}`)}),H(`click`,i,()=>Gi.go(`do`,{act:`measure`,part:V(t).component})),H(`click`,d,()=>s(V(t).component)),W(e,n)});var l=z(c,2),u=I(l),d=e=>{var t=Nr();q(L(t),17,()=>V(n),Gr,(e,t)=>{var n=io(),i=R(n,!0);B(e=>{J(n,`aria-pressed`,e),G(i,V(t))},[()=>V(r).includes(V(t))]),H(`click`,n,()=>s(V(t))),W(e,n)}),W(e,t)};K(u,e=>{V(i)&&e(d)});var f=z(u,2);A(l),A(t),B(()=>{o=fi(t,1,`tiles svelte-104dwsb`,null,o,{raised:Ua.film}),J(f,`aria-expanded`,V(i))}),H(`click`,f,()=>F(i,!V(i))),W(e,t)};K(l,e=>{V(n).length&&e(u)}),W(e,c),He()}Sr([`click`]);var so=U(`<span class="hidden"> </span>`),co=U(`<button><!><!></button>`);function lo(e,t){Ve(t,!0);let n=zi(t,`barred`,3,null),r=zi(t,`main`,3,!1),i=zi(t,`small`,3,!1),a=zi(t,`submit`,3,!1),o=zi(t,`title`,3,``),s=P(!1);async function c(){if(!(n()||V(s))){F(s,!0);try{await t.run()}finally{F(s,!1)}}}var l=co();let u;var d=I(l);ei(d,()=>t.children);var f=z(d),p=e=>{var t=so(),r=R(t);B(()=>G(r,`: ${n()??``}`)),W(e,t)};K(f,e=>{n()&&e(p)}),A(l),B(()=>{J(l,`type`,a()?`submit`:`button`),J(l,`aria-disabled`,n()||V(s)?`true`:void 0),J(l,`title`,n()??o()),u=fi(l,1,``,null,u,{main:r(),small:i()})}),H(`click`,l,e=>{a()?n()&&e.preventDefault():c()}),W(e,l),He()}Sr([`click`]);function uo(e){let t=e=>typeof e==`object`&&e&&`slot`in e?e.slot:void 0;return e.primitive===`operator`?`!`:[`park`,`measure`,`verify`].includes(e.primitive)?`·`:[`staged`,`in_the_way`].includes(e.reason.kind)?`↷`:t(e.arguments.to)?`-`:t(e.arguments.from)?`+`:`~`}function fo(e){return e.tunable===`pose`?typeof e.after==`string`?`-`:typeof e.before==`string`&&e.after!==null&&e.after!==void 0?`+`:`~`:`~`}function po(e){return[`pico`,...e].map(e=>/^[\w@%+=:,./-]+$/.test(e)?e:`'${e.replaceAll(`'`,`'\\''`)}'`).join(` `)}function mo(e){return e?e.startsWith(`-`)?[`--message=${e}`]:[`-m`,e]:[]}var ho=e=>JSON.stringify(e),go=e=>`${ho(e.slice(0,e.indexOf(`=`)))}: ${ho(e.slice(e.indexOf(`=`)+1))}`,_o=(e,t)=>{let[n=``,r=``]=e.split(`=`);return`${ho(t+n)}: ${r.trim()&&!Number.isNaN(Number(r))?r:ho(r)}`},vo={plan:([e])=>`print(bench.plan(${e?JSON.stringify(e):``}))`,apply:([e])=>`bench.apply(bench.plan(${e?JSON.stringify(e):``}))`,status:()=>`print(bench.status())`,measure:([e])=>e?`print(bench.measure(${ho(e)}))`:null,optimize:e=>e.length?`print(bench.optimize(${e.map(ho).join(`, `)}))`:null,set:([e,...t])=>t.length?`bench.set({${t.map(t=>_o(t,`${e}.`)).join(`, `)}})`:null,do:([e,t,...n])=>e&&t&&!n.length?`bench.do(${ho(e)}, ${ho(t)})`:null,capture:()=>`bench.capture()`,undo:()=>`bench.apply(bench.recovery.undo_plan())`,teleop:([e])=>`with bench.teleop(${(e??``).split(`.`).map(ho).join(`, `)}) as jog:\n    print(jog.values)  # jog.step(NAME, BY) moves it`,run:([e,...t])=>e?`from pico.recipes.recipes import Recipes\n\nrecipes = Recipes(bench)\nmade = recipes.read(${ho(e)})\nrecipes.run(made, recipes.begin(made, recipes.arguments(made, {${t.map(e=>go(e)).join(`, `)}})))`:null,runs:([e,t,n])=>({list:`for run, commit in bench.history.runs():
    print(run.id, run.goal, run.outcome)`,show:`run, commit = bench.history.recorded_run(${JSON.stringify(t??``)})\nprint(run)`,compare:`print(bench.history.compare_runs(${JSON.stringify(t??``)}, ${JSON.stringify(n??``)}))`,plot:`from pico.bench.picturing.plots import points_of\n\nrun, commit = bench.history.recorded_run(${JSON.stringify(t??``)})\nprint(points_of(bench.setup, run))`,pictures:`from pico.bench.picturing.kept import drawn, kept\n\nrun, commit = bench.history.recorded_run(${JSON.stringify(t??``)})\nfor one in kept(run):\n    picture = drawn(bench.history.folder, one).picture()  # (height, width, 3)`})[e??`list`]??null};function yo(e){let[t=``,...n]=e.filter(e=>e!==`--yes`);if([`set`,`do`,`move`,`run`,`optimize`,`measure`].includes(t)&&n.some(e=>/^-/.test(e)&&!/^-(p|-param|[\d.].*)$/.test(e)))return null;let r=vo[t]?.(n.filter(e=>!/^-(?![\d.])/.test(e)));return r?`import pico\n\nbench = pico.open(".")\n${r}`:null}function bo(e){return typeof e==`object`&&!!e}function xo(e,t=3){return String(Number(e.toFixed(t)))}function So(e,t=``){return e==null?`unknown`:bo(e)?`(${xo(e.x,2)}, ${xo(e.y,2)}, ${xo(e.yaw,2)}°)`:typeof e==`number`?t?`${xo(e)} ${t}`:xo(e):String(e)}function Co(e){if(e<60)return`${e<10?e.toFixed(1):Math.round(e)} s`;let t=Math.round(e);return`${Math.floor(t/60)} min ${t%60} s`}function wo(e,t){let n=[`optimize`,`operator`,`teleoperate`].includes(e.primitive)||e.reason.kind===`align`||e.reason.kind===`interlock`&&e.reason.of.length>0;return e.seconds>0&&!n&&t>1.5*e.seconds+2}function To(e){return new Date(e).toLocaleString(void 0,{day:`numeric`,month:`short`,hour:`2-digit`,minute:`2-digit`})}function Eo({cause:e,goal:t}){return[`single`,`teleoperation`].includes(e.kind)?t:`${e.kind} ${t}`}var Do=U(`<button class="small bare" aria-label="Copy as Python">Python</button>`),Oo=U(`<div class="copy svelte-avd1bp"><code class="cut grow svelte-avd1bp"> </code> <button class="small bare">Copy</button> <!></div>`);function ko(e,t){Ve(t,!0);let n=N(()=>po(t.words)),r=N(()=>yo(t.words));async function i(e,t){await navigator.clipboard.writeText(e),oa.say(`Copied as ${t}.`)}var a=Oo(),o=I(a),s=R(o,!0),c=z(o,2),l=z(c,2),u=e=>{var t=Do();H(`click`,t,()=>i(V(r),`Python`)),W(e,t)};K(l,e=>{V(r)&&e(u)}),A(a),B(()=>{J(o,`title`,V(n)),G(s,V(n)),J(c,`aria-label`,`Copy as command: ${V(n)??``}`)}),H(`click`,c,()=>i(V(n),`command`)),W(e,a),He()}Sr([`click`]);var Ao=new class{#e=P(qt(localStorage.getItem(`pico-theme`)));#t=P(qt(matchMedia(`(prefers-color-scheme: dark)`).matches));constructor(){matchMedia(`(prefers-color-scheme: dark)`).addEventListener(`change`,e=>F(this.#t,e.matches,!0)),this.#n()}get shown(){return V(this.#e)===`dark`||V(this.#e)===null&&V(this.#t)?`dark`:`light`}turn=()=>{F(this.#e,this.shown===`dark`?`light`:`dark`,!0),localStorage.setItem(`pico-theme`,V(this.#e)),this.#n()};#n(){V(this.#e)&&(document.documentElement.dataset.theme=V(this.#e))}};function jo({name:e,unit:t}){return t&&t!==`1`?`${e} [${t}]`:e}function Mo(e,t=[]){let n=[...e.flatMap(({values:e,sigmas:t})=>e.flatMap((e,n)=>e===null?[]:[e-(t?.[n]??0),e+(t?.[n]??0)])),...t].filter(Number.isFinite);if(!n.length)return[0,1];let r=n.reduce((e,t)=>Math.min(e,t)),i=n.reduce((e,t)=>Math.max(e,t)),a=.06*(i-r)||.1*Math.abs(i)||1;return[r-a,i+a]}function No(e,t=[]){let n=e.flatMap(e=>e.values).filter(e=>e!==null),r=[...n,...t.filter(e=>e>0)];if(!n.length||n.some(e=>e<=0))return null;let i=r.reduce((e,t)=>Math.min(e,t)),a=r.reduce((e,t)=>Math.max(e,t));return a/i<30?null:[10**Math.floor(Math.log10(i)),10**Math.ceil(Math.log10(a))]}function Po(e){return[...e].sort((e,t)=>e.x-t.x)}function Fo(e,t){let n=t.map(({name:e,values:t,sigmas:n})=>{let r=t.findLastIndex(e=>e!==null),i=n?.[r];return r<0?`${e} none`:`${e} last ${Number(t[r].toPrecision(5))}${i?` ± ${Number(i.toPrecision(2))}`:``}`});return[`${e.length} points`,...n].join(`; `)}var Io=(function(){let e=typeof document<`u`&&document.createElement(`link`).relList;return e&&e.supports&&e.supports(`modulepreload`)?`modulepreload`:`preload`})(),Lo=function(e){return`/`+e},Ro={},zo=function(e){return e.pathname.endsWith(`.css`)},Bo=function(e,t,n){if(t in e)return e[t];let r=n();if(!r){e[t]=void 0;return}let i=r.then(()=>{e[t]=void 0},n=>{throw e[t]=void 0,n});return e[t]=i,i},Vo=function(e,t,n){let r=Promise.resolve();if(t&&t.length>0){let e,i=document.querySelector(`meta[property=csp-nonce]`),a=i?.nonce||i?.getAttribute(`nonce`);function o(e){return Promise.all(e.map(e=>Promise.resolve(e).then(e=>({status:`fulfilled`,value:e}),e=>({status:`rejected`,reason:e}))))}function s(e){return import.meta.resolve?new URL(import.meta.resolve(e)):new URL(e,import.meta.url)}r=o(t.map(t=>{t=Lo(t,n);let r=s(t),i=zo(r);return Bo(Ro,r.href,()=>{if(e===void 0){e={all:new Set,styles:new Set};let t=document.getElementsByTagName(`link`);for(let n=t.length-1;n>=0;n--){let r=t[n];e.all.add(r.href),r.rel===`stylesheet`&&e.styles.add(r.href)}}if((i?e.styles:e.all).has(r.href))return;let t=document.createElement(`link`);if(t.rel=i?`stylesheet`:Io,i||(t.as=`script`),t.crossOrigin=``,t.href=r.href,a&&t.setAttribute(`nonce`,a),document.head.appendChild(t),i)return new Promise((e,n)=>{let i=a=>{t.removeEventListener(`load`,i),t.removeEventListener(`error`,i),a.type===`error`?n(Error(`Unable to preload CSS for ${r}`)):e(a)};t.addEventListener(`load`,i),t.addEventListener(`error`,i)})})}).filter(e=>e!==void 0))}function i(e){let t=new Event(`vite:preloadError`,{cancelable:!0});if(t.payload=e,window.dispatchEvent(t),!t.defaultPrevented)throw e}return r.then(t=>{for(let e of t||[])e.status===`rejected`&&i(e.reason);return e().catch(i)})},Ho=U(`<figure class="svelte-kau93b"><div aria-hidden="true"></div> <figcaption> <span class="hidden"> </span></figcaption></figure>`);function Uo(e,t){Ve(t,!0);let n=zi(t,`across`,3,``),r=zi(t,`up`,3,``),i=zi(t,`whole`,3,!1),a=zi(t,`caption`,3,!1),o=zi(t,`log`,3,!1),s=zi(t,`height`,3,150),c,l=null,u=P(null),d=P(0),f=[`#1f8fff`,`#d98e04`,`#2fa35a`,`#b65cd6`],p=N(()=>[t.x,...t.series.map(e=>e.values)]),m=N(()=>o()?No(t.series,t.level):null),h=N(()=>JSON.stringify([t.series.map(e=>[e.name,e.dots]),n(),r(),i(),s(),V(m)!==null,Ao.shown]));Bi(()=>{Promise.all([Vo(()=>import(`./uPlot.esm-BScb58at.js`),[]),Vo(()=>Promise.resolve({}),__vite__mapDeps([0]))]).then(([e])=>F(u,e.default));let e=new ResizeObserver(()=>{F(d,c.clientWidth,!0),V(d)&&l?.setSize({width:V(d),height:s()})});return e.observe(c),()=>{e.disconnect(),l?.destroy()}}),_n(()=>{if(!V(u)||!V(d))return;V(h);let e=V(u);return fr(()=>{l=g(e)}),()=>{l?.destroy(),l=null}}),_n(()=>{t.level,l?.setData(V(p))});function g(e){let a=Ao.shown===`dark`,o=a?`#a0b0bf`:`#52616f`,l=a?`#2b3743`:`#d5dce4`,u=`11px system-ui`,d={stroke:o,grid:{stroke:l,width:1},ticks:{stroke:l,width:1},font:u,labelFont:u,labelSize:16},h=(e,t)=>t==null?``:String(Number(t.toPrecision(5))),g=t.x.length===1?t.x[0]:null;return new e({width:c.clientWidth,height:s(),legend:{show:t.series.length>1},cursor:{drag:{x:!1,y:!1}},scales:{x:{time:!1,...g===null?{}:{range:[g-1,g+1]}},y:{distr:V(m)?3:1,range:()=>V(m)??Mo(t.series,t.level)}},axes:[{...d,...i()?{incrs:[1,2,5,10,20,50,100]}:{},label:n(),size:34},{...d,size:58,...r()?{label:r()}:{}}],series:[{label:n(),value:h},...t.series.map((e,t)=>({label:e.name,value:h,stroke:f[t%4],width:e.dots?0:2,points:{show:e.dots===!0,size:6,fill:f[t%4]}}))],hooks:{drawAxes:[e=>v(e,a)],draw:[y]}},V(p),c)}let _=(e,t)=>e.valToPos(V(m)?Math.max(t,V(m)[0]):t,`y`,!0);function v(e,n){if(!t.level)return;let{ctx:r,bbox:i}=e,[a,o]=[_(e,t.level[0]),_(e,t.level[1])];r.save(),r.fillStyle=n?`#2fa35a55`:`#2fa35a33`,r.fillRect(i.left,Math.min(a,o),i.width,Math.max(Math.abs(a-o),devicePixelRatio)),r.restore()}function y(e){let{ctx:n}=e;n.save(),n.lineWidth=1.5*devicePixelRatio,t.series.forEach(({values:r,sigmas:i},a)=>{n.strokeStyle=f[a%4],n.beginPath(),r.forEach((r,a)=>{let o=i?.[a];if(r===null||!o)return;let s=e.valToPos(t.x[a],`x`,!0);n.moveTo(s,_(e,r-o)),n.lineTo(s,_(e,r+o))}),n.stroke()}),n.restore()}var b=Ho(),x=I(b);Ii(x,e=>c=e,()=>c);var S=z(x,2);let C;var w=I(S,!0),T=R(z(w));A(S),A(b),B(e=>{J(b,`aria-label`,t.title),mi(x,`min-height: ${s()??``}px`),C=fi(S,1,`dim svelte-kau93b`,null,C,{hidden:!a()}),G(w,t.title),G(T,`: ${e??``}${r()?`; up: ${r()}`:``}${n()?`; across: ${n()}`:``}`)},[()=>Fo(t.x,t.series)]),W(e,b),He()}function Wo(e,t){if(t&&(t.datatype===`bool`||t.choices.length))return null;let n=Number(e.replace(`,`,`.`));if(!e.trim()||Number.isNaN(n))return`a number is wanted`;let[r,i]=t?.range??[-1/0,1/0];return n<r||n>i?`${e} is beyond ${Go(t)}`:null}function Go(e){return e?.range?`${e.range[0]} to ${e.range[1]} ${e.unit}`.trim():``}function Ko(e,t,n){let r=e=>(e??``).trim().replace(`,`,`.`);return t===`pose`?[`move`,e,...[`x`,`y`,`yaw`].map(e=>`${e}=${r(n[e])}`),`--manifest`]:[`set`,e,`${t}=${r(n.value)}`,`--manifest`]}var qo=U(`<p class="dim">No camera in the beam here: nothing to be watched.</p>`),Jo=U(`<option> </option>`),Yo=U(`<span class="badge warn"> </span>`),Xo=U(`<span class="badge bad">saturated</span>`),Zo=U(`<!> <p class="dim small row svelte-oras6j"><span class="grow"><!></span> <!><span class="number"> </span></p>`,1),Qo=U(`<p class="dim empty svelte-oras6j"> </p>`),$o=U(`<p class="note warn"> </p>`),es=U(`<div><dt class="dim svelte-oras6j"> </dt><dd class="svelte-oras6j"> <span class="dim"> </span></dd></div>`),ts=U(`<form class="row svelte-oras6j"><label for="exposure"> </label> <input id="exposure" class="short svelte-oras6j" inputmode="decimal"/> <!> <!></form> <!>`,1),ns=U(`<p class="number"> </p>`),rs=U(`<p class="warn"> </p>`),is=U(`<section class="note" aria-label="Measured"><h2 class="mono"> </h2> <!> <!> <p class="dim small svelte-oras6j"> <!></p></section>`),as=U(`<div class="row svelte-oras6j"><label for="camera" class="hidden">Camera</label> <select id="camera" class="svelte-oras6j"></select> <label for="measurable" class="hidden">What of it</label> <select id="measurable" class="grow svelte-oras6j"></select></div> <!> <!> <!> <dl class="number svelte-oras6j"></dl> <!> <!> <div class="row svelte-oras6j"><!><span class="dim small svelte-oras6j">as an operation: arms park, what it needs is set, it is kept with a run</span></div> <!> <!>`,1);function os(e,t){Ve(t,!0);let n=N(()=>(Y.scene?.components??[]).filter(e=>Object.keys(Wa(e)).length)),r=N(()=>V(n).find(e=>e.name===Gi.now.query.part&&Ga([e]).length)??Ga(V(n))[0]??V(n)[0]),i=N(()=>V(r)?.name),a=N(()=>Object.entries(Wa(V(r))).filter(([,e])=>e.kernel?.startsWith(`image |`)).map(([e])=>e)),o=P(`centroid`),s=N(()=>V(a).includes(V(o))?V(o):V(a)[0]??``),c=N(()=>[...new Set([...[`centroid`,`width`].filter(e=>V(a).includes(e)),...V(s)?[V(s)]:[]])]),l=P(null),u=P([]),d=0,f=N(()=>V(l)?.still??null),p=N(()=>V(f)?.values[V(s)]),h=N(()=>V(p)?Ka(V(p)):[]),g=N(()=>[...new Set(V(u).flatMap(e=>Object.keys(e.values)))].slice(0,2)),_=N(()=>V(r)?.tunables.exposure),v=P(``),y=N(()=>V(v)?Wo(V(v),V(_)):null),b=N(()=>[`set`,V(i)??``,`exposure=${V(v).trim().replace(`,`,`.`)||`…`}`]),x=N(()=>[`measure`,`${V(i)}.${V(s)}`]),S=N(()=>X.going?.words[0]===`measure`?X.going.said.find(e=>`schema`in e&&e.schema===`pico.measurement/v1`):void 0);_n(()=>{let e=V(i),t=V(c).join(`
`);if(!e||!t)return;let n=new Ja(e,`image`,t.split(`
`),500);return fr(()=>{F(l,n),F(u,[]),d=performance.now()}),n.begin()}),_n(()=>{let e=V(f)?.values[V(s)];V(f)&&e&&!V(f).waits&&fr(()=>{let t=Object.fromEntries(Ka(e).map(e=>[e.name||V(s),e.value]));Object.keys(t).length&&F(u,[...V(u),{at:(performance.now()-d)/1e3,values:t}].slice(-240))})});var C=Nr(),w=L(C),T=e=>{W(e,qo())},E=e=>{var t=as(),c=L(t),d=z(I(c),2);q(d,21,()=>Ga(V(n)),Gr,(e,t)=>{var n=Jo(),r=R(n,!0),i={};B(()=>{G(r,V(t).name),i!==(i=V(t).name)&&(n.__value=i)}),W(e,n)}),A(d);var C;vi(d);var w=z(d,4);q(w,21,()=>V(a),Gr,(e,t)=>{var n=Jo(),i=R(n),a={};B(e=>{G(i,`${V(t)??``}: ${e??``}`),a!==(a=V(t))&&(n.value=(n.__value=a)??``)},[()=>Wa(V(r))[V(t)]?.description??``]),W(e,n)}),A(w);var T;vi(w),A(c);var E=z(c,2),D=e=>{var t=Zo(),n=L(t);{let e=N(()=>V(i)),t=N(()=>V(h).map(e=>`${e.name} ${qa(e.value,e.sigma)} ${e.unit}`).join(`, `)||V(p)?.unknown||`no light`);$a(n,{get still(){return V(f)},get alt(){return`What ${V(e)??``} sees: ${V(t)??``}`}})}var r=z(n,2),a=I(r),o=I(a),s=e=>{var t=Yo(),n=R(t);B(e=>G(n,`${V(f).waits??``}: ${e??``} s old`),[()=>V(f).age.toFixed(0)]),W(e,t)},c=e=>{W(e,Mr(`live, by a look that assures nothing`))};K(o,e=>{V(f).waits?e(s):e(c,-1)}),A(a);var l=z(a,2),u=e=>{var t=Xo();B(()=>J(t,`title`,V(f).saturated)),W(e,t)};K(l,e=>{V(f).saturated&&e(u)});var d=R(z(l));A(r),B(e=>G(d,`${e??``} ms`),[()=>String(V(f).settings.exposure??`?`)]),W(e,t)},O=e=>{var t=Qo(),n=R(t,!0);B(()=>G(n,V(l)?.why||`Looking …`)),W(e,t)};K(E,e=>{V(f)?e(D):e(O,-1)});var ee=z(E,2),k=e=>{var t=$o(),n=R(t,!0);B(()=>G(n,V(l).why)),W(e,t)};K(ee,e=>{V(f)&&V(l)?.why&&e(k)});var te=z(ee,2),ne=e=>{var t=$o(),n=R(t,!0);B(()=>G(n,V(p).unknown)),W(e,t)};K(te,e=>{V(p)?.unknown&&e(ne)});var re=z(te,2);q(re,21,()=>V(h),Gr,(e,t)=>{var n=es(),r=I(n),i=R(r,!0),a=z(r),o=I(a),c=R(z(o),!0);A(a),A(n),B(e=>{G(i,V(t).name||V(s)),G(o,`${e??``} `),G(c,V(t).unit)},[()=>qa(V(t).value,V(t).sigma)]),W(e,n)}),A(re);var ie=z(re,2),ae=e=>{{let t=N(()=>V(p)?.unit.split(`, `)[0]?`[${V(p).unit.split(`, `)[0]}]`:``),n=N(()=>V(u).map(e=>e.at)),r=N(()=>V(g).map(e=>({name:e,values:V(u).map(t=>t.values[e]??null)})));Uo(e,{get title(){return`${V(i)??``}.${V(s)??``} over time`},across:`time [s]`,get up(){return V(t)},get x(){return V(n)},get series(){return V(r)}})}};K(ie,e=>{V(u).length>1&&e(ae)});var oe=z(ie,2),se=e=>{var t=ts(),n=L(t),r=I(n),a=R(r),o=z(r,2);Ei(o);var s=z(o,2);{let e=N(()=>V(y)??(V(v)?Y.barred:`type an exposure`));lo(s,{submit:!1,run:()=>X.move([...V(b),`--yes`]),get barred(){return V(e)},children:(e,t)=>{Ce(),W(e,Mr(`Set`))},$$slots:{default:!0}})}lo(z(s,2),{run:()=>X.move([`do`,V(i),`auto_range`,`--yes`]),get barred(){return Y.barred},title:`Finds an exposure that suits`,children:(e,t)=>{Ce(),W(e,Mr(`Auto`))},$$slots:{default:!0}}),A(n);var c=z(n,2),l=e=>{ko(e,{get words(){return V(b)}})},u=e=>{{let t=N(()=>[`do`,V(i)??``,`auto_range`]);ko(e,{get words(){return V(t)}})}};K(c,e=>{V(v)?e(l):e(u,-1)}),B((e,t)=>{G(a,`Exposure [${V(_).unit??``}]`),J(o,`placeholder`,e),J(o,`aria-invalid`,V(y)?`true`:void 0),J(o,`title`,t)},[()=>String(V(f)?.settings.exposure??``),()=>Go(V(_))]),xr(`submit`,n,e=>e.preventDefault()),ji(o,()=>V(v),e=>F(v,e)),W(e,t)};K(oe,e=>{V(_)&&e(se)});var ce=z(oe,2);lo(I(ce),{main:!0,run:()=>X.move([...V(x),`--yes`]),get barred(){return Y.barred},children:(e,t)=>{Ce();var n=Mr();B(()=>G(n,`Measure ${V(s)??``}`)),W(e,n)},$$slots:{default:!0}}),Ce(),A(ce);var le=z(ce,2);ko(le,{get words(){return V(x)}});var ue=z(le,2),de=e=>{var t=is(),n=I(t),r=R(n),i=z(n,2);q(i,17,()=>Ka(V(S)),Gr,(e,t)=>{var n=ns(),r=R(n);B(e=>G(r,`${V(t).name??``} ${e??``} ${V(t).unit??``}`),[()=>qa(V(t).value,V(t).sigma)]),W(e,n)});var a=z(i,2),o=e=>{var t=rs(),n=R(t,!0);B(()=>G(n,V(S).unknown)),W(e,t)};K(a,e=>{V(S).unknown&&e(o)});var s=z(a,2),c=I(s);q(z(c),17,()=>Object.entries(V(S).not_assured),Gr,(e,t)=>{var n=N(()=>m(V(t),2));let r=()=>V(n)[0],i=()=>V(n)[1];Ce();var a=Mr();B(()=>G(a,`; not ${r()??``}: ${i()??``}`)),W(e,a)}),A(s),A(t),B(e=>{G(r,`${V(S).component??``}.${V(S).measurable??``}`),G(c,`assured: ${e??``}`)},[()=>V(S).assured.join(`, `)||`nothing`]),W(e,t)};K(ue,e=>{V(S)&&e(de)}),B(()=>{C!==(C=V(i))&&(d.value=(d.__value=C)??``,_i(d,C)),T!==(T=V(s))&&(w.value=(w.__value=T)??``,_i(w,T))}),H(`change`,d,e=>Gi.set({part:e.currentTarget.value})),H(`change`,w,e=>{F(o,e.currentTarget.value,!0),F(u,[])}),W(e,t)};K(w,e=>{V(r)?e(E,-1):e(T)}),W(e,C),He()}Sr([`change`]);function ss(e){let t=t=>{let n={ArrowDown:1,ArrowUp:-1}[t.key],r=[...e.querySelectorAll(`[data-row]`)],i=r.indexOf(document.activeElement),a=t.key===`Home`?0:t.key===`End`?r.length-1:n===void 0||i<0?-1:i+n;r[a]&&(t.preventDefault(),r[a].focus())};return e.addEventListener(`keydown`,t),{destroy:()=>e.removeEventListener(`keydown`,t)}}var cs=new class{#e=P(null);get all(){return V(this.#e)}set all(e){F(this.#e,e)}#t=P(null);get ahead(){return V(this.#t)}set ahead(e){F(this.#t,e)}async look(){this.all=await X.read(`pico.goals/v1`,`optimize`)??this.all}async dry(e){this.ahead=null,this.ahead=await X.read(`pico.goal/v1`,...e,`--dry-run`)}},ls=new class{#e=P(null);get all(){return V(this.#e)}set all(e){F(this.#e,e)}#t=P(null);get ahead(){return V(this.#t)}set ahead(e){F(this.#t,e)}#n=P([]);get wrong(){return V(this.#n)}set wrong(e){F(this.#n,e)}#r=P(``);get checked(){return V(this.#r)}set checked(e){F(this.#r,e,!0)}async look(){this.all=await X.read(`pico.recipes/v1`,`recipe`,`list`)??this.all}async check(e,t){let n=await X.run([`recipe`,`check`,e,...t]),r=e=>n.said.find(t=>`schema`in t&&t.schema===e);this.ahead=r(`pico.recipe_ahead/v1`)??null,this.wrong=[...r(`pico.diagnostics/v1`)?.diagnostics??[],...this.ahead?[]:n.diagnostics],this.checked=[e,...t].join(` `)}};function us(e){return e.filter(e=>e.kind===`operation_progress`&&`measured`in e.data).map(({data:e})=>{let t=e.objective;return{measured:Number(e.measured),value:t?.value??null,best:t?.best??null,objective:t?.name??``,point:e.point??{},values:e.values??{},unknown:String(e.unknown??``)}})}function ds(e){return Object.entries(e).filter(([e])=>!e.endsWith(`_sigma`)).map(([t,n])=>({name:t,value:n,sigma:e[`${t}_sigma`]??null}))}function fs(e,t){return e?.said.find(e=>`schema`in e&&e.schema===t)??null}var ps=U(`<span class="dim number"> </span>`),ms=U(`<p class="dim small why svelte-i3r2tu"> </p>`),hs=U(`<li class="svelte-i3r2tu"><button data-row="" class="svelte-i3r2tu"><span class="grow cut mono"> </span><span> </span> <!></button><!></li>`),gs=U(`<li class="dim none svelte-i3r2tu"> </li>`),_s=U(`<option> </option>`),vs=U(`<label for="given"> </label> <input id="given" autocomplete="off" placeholder="names, with spaces between"/>`,1),ys=U(`<br/> `,1),bs=U(`<p class="dim"> <!></p>`),xs=U(`<li class="svelte-i3r2tu"><span class="mono"> </span><!></li>`),Ss=U(`<section class="note svelte-i3r2tu" aria-label="What would be done"><p>By <strong> </strong> </p> <ul class="plain small svelte-i3r2tu"></ul></section>`),Cs=U(`<p class="number small svelte-i3r2tu" role="status"> </p>`),ws=U(`<!> <!>`,1),Ts=U(`<tr><th scope="row" class="mono svelte-i3r2tu"> </th><td class="number svelte-i3r2tu"> </td><td class="number svelte-i3r2tu"> </td></tr>`),Es=U(`<table class="svelte-i3r2tu"><thead class="svelte-i3r2tu"><tr><th class="svelte-i3r2tu"></th><th scope="col" class="svelte-i3r2tu">before</th><th scope="col" class="svelte-i3r2tu">after</th></tr></thead><tbody></tbody></table>`),Ds=U(`<section aria-label="What it came to"><h2> <span> </span></h2> <p> </p> <!> <div class="row"><!></div> <!></section>`),Os=U(`<ol class="plain list svelte-i3r2tu" aria-label="Goals"></ol> <div class="row"><label for="ready">Ready made</label> <select id="ready" class="grow"><option>none: a goal of the lab</option><!></select></div> <!> <div class="row wrap svelte-i3r2tu"><!> <!> <!></div> <!> <!> <!> <!>`,1);function ks(e,t){Ve(t,!0);let n=P(``),r=P(``),i=P(``);_n(()=>{Y.name&&fr(()=>void cs.look())});let a={aligned:`ok`,stale:`warn`,lost:`bad`},o=N(()=>V(n)||cs.all?.alignments[0]?.goal||``),s=N(()=>V(r)?[`optimize`,V(r),...V(i).trim().split(/\s+/).filter(Boolean)]:[`optimize`,V(o)]),c=N(()=>X.going?.words[0]===`optimize`?X.going:null),l=N(()=>us(V(c)?.events??[])),u=N(()=>V(l).at(-1)??null),d=N(()=>fs(V(c),`pico.optimization/v1`)),f=N(()=>cs.all?.goals[V(o)]),p=N(()=>V(c)&&V(c).exit===null?`one is sought already`:Y.barred??(V(r)&&!V(i).trim()?`say for what: ${cs.all?.ready[V(r)]?.split(`:`)[0]??``}`:!V(r)&&!V(o)?`choose a goal`:null));async function h(){cs.ahead=null,await X.move([...V(s),`--yes`]),await cs.look()}var g=Os(),_=L(g);q(_,21,()=>cs.all?.alignments??[],e=>e.goal,(e,t,i,s)=>{var c=hs(),l=I(c),u=I(l),d=R(u,!0),f=z(u),p=R(f,!0),m=z(f,2),h=e=>{var n=ps(),r=R(n,!0);B(e=>G(r,e),[()=>To(V(t).at)]),W(e,n)};K(m,e=>{V(t).at&&e(h)}),A(l);var g=z(l),_=e=>{var n=ms(),r=R(n,!0);B(()=>G(r,V(t).why)),W(e,n)};K(g,e=>{V(t).why&&e(_)}),A(c),B(()=>{J(l,`aria-pressed`,!V(r)&&V(t).goal===V(o)),G(d,V(t).goal),fi(f,1,`badge ${a[V(t).status]??``??``}`,`svelte-i3r2tu`),G(p,V(t).status)}),H(`click`,l,()=>{F(n,V(t).goal,!0),F(r,``),cs.ahead=null}),W(e,c)},e=>{var t=gs(),n=R(t,!0);B(()=>G(n,cs.all?"The lab has no goals of its own: `goals:` in lab.yaml.":`Reading …`)),W(e,t)}),A(_),ri(_,e=>ss?.(e));var v=z(_,2),y=z(I(v),2),b=I(y);b.value=b.__value=``,q(z(b),17,()=>Object.entries(cs.all?.ready??{}),Gr,(e,t)=>{var n=N(()=>m(V(t),2));let r=()=>V(n)[0],i=()=>V(n)[1];var a=_s(),o=R(a),s={};B(()=>{G(o,`${r()??``} ${i()??``}`),s!==(s=r())&&(a.value=(a.__value=s)??``)}),W(e,a)}),A(y);var x;vi(y),A(v);var S=z(v,2),C=e=>{var t=vs(),n=L(t),a=R(n,!0),o=z(n,2);Ei(o),B(()=>G(a,cs.all?.ready[V(r)])),ji(o,()=>V(i),e=>F(i,e)),W(e,t)},w=e=>{var t=bs(),n=I(t,!0),r=z(n),i=e=>{var t=ys(),n=z(L(t));B(e=>G(n,`At most ${V(f).budget.measurements??``} measurements and ${e??``}.`),[()=>Co(V(f).budget.seconds)]),W(e,t)};K(r,e=>{V(f).budget&&e(i)}),A(t),B(()=>G(n,V(f).description)),W(e,t)};K(S,e=>{V(r)?e(C):V(f)&&e(w,1)});var T=z(S,2),E=I(T);{let e=N(()=>V(p)===Y.barred?null:V(p));lo(E,{run:()=>cs.dry(V(s)),get barred(){return V(e)},title:`Says what would be done; moves nothing`,children:(e,t)=>{Ce(),W(e,Mr(`Look ahead`))},$$slots:{default:!0}})}var D=z(E,2);lo(D,{main:!0,run:h,get barred(){return V(p)},children:(e,t)=>{Ce(),W(e,Mr(`Seek it`))},$$slots:{default:!0}});var O=z(D,2),ee=e=>{lo(e,{run:()=>X.cancel(),title:`It ends at the best point that was found`,children:(e,t)=>{Ce(),W(e,Mr(`End at the best`))},$$slots:{default:!0}})};K(O,e=>{V(c)&&V(c).exit===null&&e(ee)}),A(T);var k=z(T,2);ko(k,{get words(){return V(s)}});var te=z(k,2),ne=e=>{let t=N(()=>cs.ahead);var n=Ss(),r=I(n),i=z(I(r)),a=R(i,!0),o=z(i);A(r);var s=z(r,2);q(s,21,()=>Object.entries(V(t).goal.tunables),Gr,(e,t)=>{var n=N(()=>m(V(t),2));let r=()=>V(n)[0],i=()=>V(n)[1];var a=xs(),o=I(a),s=R(o,!0),c=z(o),l=e=>{var t=Mr();B(()=>G(t,`from ${i()[0]??``} to ${i()[1]??``}`)),W(e,t)};K(c,e=>{i()&&e(l)}),A(a),B(()=>G(s,r())),W(e,a)}),A(s),A(n),B((e,n)=>{G(a,e),G(o,`: ${V(t).why??``}. About ${n??``}.`)},[()=>V(t).algorithm.replaceAll(`_`,` `),()=>Co(V(t).seconds)]),W(e,n)};K(te,e=>{cs.ahead&&e(ne)});var re=z(te,2),ie=e=>{var t=ws(),n=L(t);{let e=N(()=>V(u)?.objective||`objective`),t=N(()=>V(l).map(e=>e.measured)),r=N(()=>[{name:V(u)?.objective||`objective`,values:V(l).map(e=>e.value),dots:!0},{name:`best so far`,values:V(l).map(e=>e.best)}]);Uo(n,{get title(){return V(e)},across:`measurement`,whole:!0,get x(){return V(t)},get series(){return V(r)}})}var r=z(n,2),i=e=>{var t=Cs(),n=R(t);B(e=>G(n,`measurement ${V(u).measured??``}: ${e??``}`),[()=>ds(V(u).values).map(e=>`${e.name} ${qa(e.value,e.sigma)}`).join(`, `)||V(u).unknown]),W(e,t)};K(r,e=>{V(u)&&!V(d)&&e(i)}),W(e,t)};K(re,e=>{V(l).length&&e(ie)});var ae=z(re,2),oe=e=>{var t=Ds(),n=I(t),r=I(n),i=z(r),a=R(i,!0);A(n);var o=z(n,2),s=R(o),c=z(o,2),l=e=>{var t=Es(),n=z(I(t));q(n,21,()=>ds(V(d).last),Gr,(e,t)=>{var n=Ts(),r=I(n),i=R(r,!0),a=z(r),o=R(a,!0),s=R(z(a),!0);A(n),B((e,n)=>{G(i,V(t).name),G(o,e),G(s,n)},[()=>V(d).first?.[V(t).name]===void 0?``:xo(V(d).first[V(t).name],4),()=>qa(V(t).value,V(t).sigma)]),W(e,n)}),A(n),A(t),W(e,t)};K(c,e=>{V(d).last&&e(l)});var u=z(c,2);lo(I(u),{run:()=>X.move([`undo`,`--yes`]),get barred(){return Y.barred},children:(e,t)=>{Ce(),W(e,Mr(`Go back`))},$$slots:{default:!0}}),A(u),ko(z(u,2),{words:[`undo`]}),A(t),B(e=>{fi(t,1,`note ${V(d).met?``:`warn`}`,`svelte-i3r2tu`),G(r,`${V(d).goal??``}: `),fi(i,1,`badge ${V(d).met?`ok`:`warn`}`),G(a,V(d).met?`met`:`not met`),G(s,`${V(d).why??``}; ${V(d).measurements??``} measurements, ${e??``}.`)},[()=>Co(V(d).seconds)]),W(e,t)};K(ae,e=>{V(d)&&e(oe)}),B(()=>{x!==(x=V(r))&&(y.value=(y.__value=x)??``,_i(y,x))}),H(`change`,y,e=>{F(r,e.currentTarget.value,!0),cs.ahead=null}),W(e,g),He()}Sr([`click`,`change`]);var As=U(`<p> </p>`),js=U(`<p class="dim svelte-2p1nug"> </p>`),Ms=U(`<li><strong> </strong> <!> <!></li>`),Ns=U(`<ul class="plain svelte-2p1nug"></ul>`);function Ps(e,t){Ve(t,!0);var n=Nr(),r=L(n),i=e=>{var n=Ns();q(n,21,()=>t.found,Gr,(e,t)=>{var n=Ms();let r;var i=I(n),a=R(i,!0),o=z(i,2),s=e=>{var n=As(),r=R(n,!0);B(()=>G(r,V(t).detail)),W(e,n)};K(o,e=>{V(t).detail&&e(s)});var c=z(o,2),l=e=>{var n=js(),r=R(n,!0);B(()=>G(r,V(t).hint)),W(e,n)};K(c,e=>{V(t).hint&&e(l)}),A(n),B(e=>{r=fi(n,1,`note svelte-2p1nug`,null,r,{bad:V(t).severity===`error`,warn:V(t).severity===`warning`}),G(a,e)},[()=>qi(V(t))]),W(e,n)}),A(n),W(e,n)};K(r,e=>{t.found.length&&e(i)}),W(e,n),He()}var Fs=U(`<div class="row wrap svelte-1elk39g"></div>`),Is=U(`<div class="row"><label> </label> <input class="grow svelte-1elk39g" autocomplete="off"/> <!></div> <p class="small svelte-1elk39g"> </p>`,1),Ls=U(`<p class="small svelte-1elk39g">Where nobody is there it is left out.</p>`),Rs=U(`<p class="small svelte-1elk39g"> </p>`),zs=U(`<form class="note warn svelte-1elk39g" aria-label="The recipe asks"><p role="status"> </p> <!> <!> <!> <!></form>`);function Bs(e,t){Ve(t,!0);let n=P(``),r,i=N(()=>X.mayAnswer),a=N(()=>t.question.kind===`confirm`||t.question.kind===`bool`?[`yes`,`no`]:t.question.choices),o=N(()=>Aa(t.question.default)),s={yes:`Yes`,no:`No`};Bi(()=>{let e=document.activeElement;!V(i)&&(!e||e===document.body||e instanceof HTMLButtonElement)&&r.querySelector(`input, button`)?.focus()});var c=zs(),l=I(c),u=R(l,!0),d=z(l,2),f=e=>{var n=Fs();q(n,21,()=>V(a),Gr,(e,n)=>{{let r=N(()=>V(o)?V(n)===V(o):V(n)===`yes`),a=N(()=>t.question.kind===`confirm`&&V(n)===`no`?`The step fails`:``);lo(e,{get main(){return V(r)},get barred(){return V(i)},run:()=>X.answer(V(n)),get title(){return V(a)},children:(e,t)=>{Ce();var r=Mr();B(()=>G(r,s[V(n)]??V(n))),W(e,r)},$$slots:{default:!0}})}}),A(n),W(e,n)},p=e=>{var r=Is(),a=L(r),s=I(a),c=R(s),l=z(s,2);Ei(l),lo(z(l,2),{main:!0,get barred(){return V(i)},run:()=>X.answer(V(n)),children:(e,t)=>{Ce(),W(e,Mr(`Answer`))},$$slots:{default:!0}}),A(a);var u=z(a,2),d=R(u);B(()=>{J(s,`for`,`answer-${t.question.id??``}`),G(c,`${t.question.name??``}${t.question.unit?` [${t.question.unit}]`:``}`),J(l,`id`,`answer-${t.question.id??``}`),J(l,`placeholder`,V(o)),J(l,`aria-describedby`,`asks-${t.question.id??``} wants-${t.question.id??``}`),l.disabled=V(i)!==null,J(u,`id`,`wants-${t.question.id??``}`),G(d,`${t.question.wanted??``}${V(o)?`; without a word ${V(o)}`:``}`)}),ji(l,()=>V(n),e=>F(n,e)),W(e,r)};K(d,e=>{V(a).length?e(f):e(p,-1)});var m=z(d,2),h=e=>{W(e,Ls())};K(m,e=>{t.question.unattended===`skip`&&e(h)});var g=z(m,2),_=e=>{var t=Rs(),n=R(t);B(()=>G(n,`Not for you to answer: ${V(i)??``}.`)),W(e,t)};K(g,e=>{V(i)&&e(_)}),Ps(z(g,2),{get found(){return X.refused}}),A(c),Ii(c,e=>r=e,()=>r),B(()=>{J(l,`id`,`asks-${t.question.id??``}`),G(u,t.question.text)}),xr(`submit`,c,e=>{e.preventDefault(),X.answer(V(n))}),W(e,c),He()}var Vs=U(`<span class="badge bad">has mistakes</span>`),Hs=U(`<span class="badge warn">asks</span>`),Us=U(`<li class="svelte-d3ymgs"><button data-row="" class="svelte-d3ymgs"><span class="mono"> </span><span class="grow cut dim"> </span> <!></button></li>`),Ws=U(`<li class="dim none svelte-d3ymgs"> </li>`),Gs=U(`<p class="note warn"> <code> </code>, and watch it here.</p>`),Ks=U(`<p class="dim small svelte-d3ymgs"> </p>`),qs=U(`<option> </option>`),Js=U(`<select></select>`),Ys=U(`<input autocomplete="off"/>`),Xs=U(`<label> </label> <!>`,1),Zs=U(`<div class="form svelte-d3ymgs"></div>`),Qs=U(`<span class="dim number"> </span>`),$s=U(`<p class="dim small svelte-d3ymgs">It goes on though this page is closed; open it again and it is followed here.</p>`),ec=U(`<span class="badge"> </span>`),tc=U(`<li class="asks svelte-d3ymgs"><!></li>`),nc=U(`<li><span class="mark svelte-d3ymgs"> </span><span class="dim path mono svelte-d3ymgs"> </span><span class="grow cut"> </span><!><span class="dim number"> </span></li> <!>`,1),rc=U(`<p class="number small svelte-d3ymgs" role="status"> </p> <ol class="plain list tree svelte-d3ymgs" aria-label="Steps" tabindex="0"></ol>`,1),ic=U(`<!> <!> <div class="row wrap svelte-d3ymgs"><!> <!> <!> <!> <!></div> <!> <!> <!> <!>`,1),ac=U(`<!> <ol class="plain list svelte-d3ymgs" aria-label="Recipes"></ol> <!>`,1);function oc(e,t){Ve(t,!0);let n=P(``),r=P(qt({})),i=N(()=>ls.all?.recipes??[]),a=N(()=>X.going?.words[0]===`run`?X.going:null),o=N(()=>V(a)!==null&&V(a).exit===null);_n(()=>{V(o),Y.name&&fr(()=>void ls.look())});let s=N(()=>V(i).find(e=>e.name===(V(n)||Da(V(a)?.words??[])))??V(i)[0]),c=N(()=>V(s)?.inputs??[]),l=N(()=>ja(V(c),V(r))),u=N(()=>[`run`,V(s)?.name??``,...V(l)]),d=N(()=>ls.all?.cut_short.find(e=>e.recipe===V(s)?.name)),f=N(()=>V(s)?.asks??[]),p=N(()=>V(s)?.steered??[]),m=N(()=>V(s)?V(s).wrong?`the recipe has mistakes`:V(o)?`a recipe runs already`:V(p).length?`a part of it is steered by the keys of a terminal`:Y.barred:`no recipe is chosen`),h=N(()=>ls.ahead&&ls.ahead.recipe===V(s)?.name?ls.ahead:null),g=N(()=>V(a)!==null&&[``,V(s)?.name].includes(Da(V(a).words))),_=N(()=>Na(V(h)?.steps??[],V(g)?V(a).said:[],V(a)?.exit===0)),v=N(()=>V(_).filter(e=>e.state===`done`||e.state===`before`).length),y=N(()=>X.question),b=N(()=>V(y)!==null&&V(g)&&V(_).some(e=>e.path===V(y).path)),x={waiting:`·`,going:`▸`,done:`✓`,before:`=`};function S(e){F(n,e,!0),F(r,{},!0),ls.ahead=null,ls.wrong=[]}_n(()=>{let e=V(_).findLast(e=>e.state===`going`);e&&V(o)&&document.getElementById(`step-${e.path}`)?.scrollIntoView({block:`nearest`})});var C=ac(),w=L(C),T=e=>{var t=Nr();Wr(L(t),()=>V(y).id,e=>{Bs(e,{get question(){return V(y)}})}),W(e,t)};K(w,e=>{V(y)&&!V(b)&&e(T)});var E=z(w,2);q(E,21,()=>V(i),e=>e.name,(e,t)=>{var n=Us(),r=I(n),i=I(r),a=R(i,!0),o=z(i),c=R(o,!0),l=z(o,2),u=e=>{W(e,Vs())},d=e=>{W(e,Hs())};K(l,e=>{V(t).wrong?e(u):V(t).asks.length&&e(d,1)}),A(r),A(n),B(()=>{J(r,`aria-pressed`,V(t)===V(s)),G(a,V(t).name),G(c,V(t).title)}),H(`click`,r,()=>S(V(t).name)),W(e,n)},e=>{var t=Ws(),n=R(t,!0);B(()=>G(n,ls.all?"No recipes here: files of `recipes/` that say `kind: Recipe`.":`Reading …`)),W(e,t)}),A(E),ri(E,e=>ss?.(e));var D=z(E,2),O=e=>{var t=ic(),n=L(t),i=e=>{var t=Gs(),n=I(t),r=R(z(n));Ce(),A(t),B(e=>{G(n,`A part of this recipe is steered by the keys of a terminal (${e??``}): run it there, `),G(r,`pico run ${V(s).name??``}`)},[()=>V(p).join(`; `)]),W(e,t)},g=e=>{var t=Ks(),n=R(t);B(e=>G(n,`On the way it asks, to be answered here: ${e??``}`),[()=>V(f).join(`; `)]),W(e,t)};K(n,e=>{V(p).length?e(i):V(f).length&&!V(o)&&e(g,1)});var S=z(n,2),C=e=>{var t=Zs();q(t,21,()=>V(c),e=>e.name,(e,t)=>{var n=Xs(),i=L(n),a=R(i),o=z(i,2),s=e=>{var n=Js();q(n,21,()=>V(t).choices,Gr,(e,t)=>{var n=qs(),r=R(n,!0),i={};B(()=>{G(r,V(t)),i!==(i=V(t))&&(n.__value=i)}),W(e,n)}),A(n);var i;vi(n),B(e=>{J(n,`id`,`p-${V(t).name??``}`),i!==(i=e)&&(n.value=(n.__value=i)??``,_i(n,i))},[()=>V(r)[V(t).name]??Aa(V(t).default)]),H(`change`,n,e=>V(r)[V(t).name]=e.currentTarget.value),W(e,n)},c=e=>{var n=Ys();Ei(n),B((e,i)=>{J(n,`id`,`p-${V(t).name??``}`),Di(n,V(r)[V(t).name]??``),J(n,`placeholder`,e),J(n,`title`,i)},[()=>Aa(V(t).default),()=>[V(t).description,V(t).low!==null&&V(t).high!==null?`${V(t).low} to ${V(t).high}`:``].filter(Boolean).join(`; `)]),H(`input`,n,e=>V(r)[V(t).name]=e.currentTarget.value),W(e,n)};K(o,e=>{V(t).choices.length?e(s):e(c,-1)}),B(()=>{J(i,`for`,`p-${V(t).name??``}`),J(i,`title`,V(t).description),G(a,`${V(t).name??``}${V(t).unit?` [${V(t).unit}]`:``}`)}),W(e,n)}),A(t),W(e,t)};K(S,e=>{V(c).length&&e(C)});var w=z(S,2),T=I(w);{let e=N(()=>V(s).wrong?`the recipe has mistakes`:null);lo(T,{run:()=>ls.check(V(s).name,V(l)),get barred(){return V(e)},title:`Plans what is known in advance; moves nothing`,children:(e,t)=>{Ce(),W(e,Mr(`Check`))},$$slots:{default:!0}})}var E=z(T,2);lo(E,{main:!0,run:()=>X.move([...V(u),`--yes`]),get barred(){return V(m)},children:(e,t)=>{Ce(),W(e,Mr(`Run`))},$$slots:{default:!0}});var D=z(E,2),O=e=>{lo(e,{run:()=>X.move([`run`,V(s).name,`--resume`,`--yes`]),get barred(){return Y.barred},title:`Goes on with what was cut short`,children:(e,t)=>{Ce(),W(e,Mr(`Go on`))},$$slots:{default:!0}})};K(D,e=>{V(d)&&!V(o)&&e(O)});var ee=z(D,2),k=e=>{lo(e,{run:()=>X.cancel(),title:`Nothing more starts; it can be gone on with`,children:(e,t)=>{Ce(),W(e,Mr(`Stop it`))},$$slots:{default:!0}})};K(ee,e=>{V(o)&&e(k)});var te=z(ee,2),ne=e=>{var t=Qs(),n=R(t);B(e=>G(n,`about ${e??``}${V(h).whole?``:`, as far as is known`}`),[()=>Co(V(h).seconds)]),W(e,t)};K(te,e=>{V(h)&&e(ne)}),A(w);var re=z(w,2),ie=e=>{W(e,$s())};K(re,e=>{V(o)&&e(ie)});var ae=z(re,2);ko(ae,{get words(){return V(u)}});var oe=z(ae,2);Ps(oe,{get found(){return ls.wrong}});var se=z(oe,2),ce=e=>{var t=rc(),n=L(t),r=R(n),i=z(n,2);q(i,21,()=>V(_),e=>e.path,(e,t)=>{var n=nc(),r=L(n),i=I(r),a=R(i,!0),o=z(i),s=R(o,!0),c=z(o);let l;var u=R(c,!0),d=z(c),f=e=>{var n=ec(),r=R(n,!0);B(()=>G(r,V(t).turn)),W(e,n)};K(d,e=>{V(t).turn&&e(f)});var p=R(z(d),!0);A(r);var m=z(r,2),h=e=>{var t=tc();Wr(I(t),()=>V(y).id,e=>{Bs(e,{get question(){return V(y)}})}),A(t),W(e,t)};K(m,e=>{V(y)&&V(b)&&V(t).path===V(y).path&&e(h)}),B(()=>{J(r,`id`,`step-${V(t).path??``}`),fi(r,1,oi(V(t).state),`svelte-d3ymgs`),J(r,`aria-current`,V(t).state===`going`?`step`:void 0),J(i,`title`,V(t).state),G(a,x[V(t).state]),G(s,V(t).path),l=mi(c,``,l,{"padding-left":`${V(t).depth*12}px`}),G(u,V(t).title),G(p,V(t).said)}),W(e,n)}),A(i),B(()=>G(r,`${V(v)??``} of ${V(_).length??``} steps${V(a)?.exit===0?`, done`:V(a)&&V(a).exit!==null?`, cut short`:``}`)),W(e,t)};K(se,e=>{V(_).length&&e(ce)}),W(e,t)};K(D,e=>{V(s)&&e(O)}),W(e,C),He()}Sr([`click`,`change`,`input`]);var sc=U(`<button type="button"><!></button>`);function cc(e,t){Ve(t,!0);let n=zi(t,`barred`,3,null),r=P(!1);function i(){V(r)||n()||(F(r,!0),t.hold())}function a(){V(r)&&(F(r,!1),t.release())}let o=e=>e.key===` `||e.key===`Enter`;var s=sc();let c;ei(I(s),()=>t.children),A(s),B(()=>{J(s,`aria-label`,t.label),J(s,`aria-disabled`,n()?`true`:void 0),J(s,`title`,n()??`Hold it`),c=fi(s,1,`svelte-qne7th`,null,c,{down:V(r)})}),H(`pointerdown`,s,e=>{e.button===0&&i()}),H(`pointerup`,s,a),xr(`pointercancel`,s,a),xr(`pointerleave`,s,a),xr(`blur`,s,a),H(`keydown`,s,e=>{o(e)&&(e.preventDefault(),e.repeat||i())}),H(`keyup`,s,e=>{o(e)&&a()}),H(`contextmenu`,s,e=>e.preventDefault()),W(e,s),He()}Sr([`pointerdown`,`pointerup`,`keydown`,`keyup`,`contextmenu`]);var lc=U(`<dialog><div class="inside svelte-1dopxlj"><h2 class="svelte-1dopxlj"> </h2> <!> <button class="stop svelte-1dopxlj" title="Stop at once (Ctrl .)">STOP</button></div></dialog>`);function uc(e,t){Ve(t,!0);let n=zi(t,`wide`,3,!1),r;Bi(()=>{r.showModal(),r.querySelector(`[data-first]`)?.focus()});var i=lc();let a;var o=I(i),s=I(o),c=R(s,!0),l=z(s,2);ei(l,()=>t.children);var u=z(l,2);A(o),A(i),Ii(i,e=>r=e,()=>r),B(()=>{J(i,`aria-label`,t.title),a=fi(i,1,`svelte-1dopxlj`,null,a,{wide:n()}),G(c,t.title),u.disabled=!Y.name}),xr(`close`,i,function(...e){t.close?.apply(this,e)}),H(`click`,i,e=>e.target===r&&r.close()),H(`click`,u,()=>Y.stop()),W(e,i),He()}Sr([`click`]);var dc=class{#e=0;#t=0;#n=0;#r=0;held=null;hold(e,t){return this.#t+=1,this.held={tunable:e,by:t},this.frame()}release(){return this.held=null,{...this.frame(),release:!0}}frame(e=!1){let t=e?null:this.held;return{seq:++this.#e,seen:this.#r,press:t?this.#t:0,tunable:t?.tunable??``,by:t?.by??0,release:!1,end:e}}heard(e){this.#r=e.clock,(e.refused||e.missed>this.#n)&&(this.held=null),this.#n=e.missed}},fc={"":``,released:`it was let go`,silent:`the edge heard nothing for 0.2 s`,late:`what it heard was too long on its way`,refused:`the step was refused`};function pc(e){return e.stopped===`refused`&&e.limit?e.limit:fc[e.stopped]}function mc(e,t){return e===void 0?`?`:e.toFixed(Math.max(0,Math.min(6,-Math.floor(Math.log10(t)))))}function hc(e,t,n){let r=e.findIndex(e=>e>=t);return e[Math.max(0,Math.min(e.length-1,(r<0?e.length-1:r)+n))]}var gc=class{#e;#t=new Map;#n=0;opened;constructor(e,t,n){this.#e=new WebSocket(new URL(e,location.href.replace(/^http/,`ws`))),this.opened=new Promise(e=>{this.#e.onopen=()=>{this.#e.send(JSON.stringify({hello:{session:t}})),e()}}),this.#e.onmessage=({data:e})=>this.#r(JSON.parse(e)),this.#e.onclose=()=>{for(let e of this.#t.values())e.failed(new Ki(0,[{severity:`error`,code:`away`,summary:`the line to the coordinator is lost`}]));this.#t.clear(),n()}}get waiting(){return this.#t.size}call(e,...t){if(this.#e.readyState!==WebSocket.OPEN)return Promise.reject(new Ki(0,[]));let n=++this.#n;return this.#e.send(JSON.stringify({id:n,call:e,with:t})),new Promise((e,t)=>this.#t.set(n,{done:t=>e(t),failed:t}))}close(){this.#e.close()}#r(e){let t=e.id===void 0?void 0:this.#t.get(e.id);t&&(this.#t.delete(e.id),e.error?t.failed(new Ki(400,e.error)):t.done(e.value))}},_c=33,vc=100,yc=new class{#e=P(null);get begun(){return V(this.#e)}set begun(e){F(this.#e,e)}#t=P(null);get answer(){return V(this.#t)}set answer(e){F(this.#t,e)}#n=P(0);get heard(){return V(this.#n)}set heard(e){F(this.#n,e,!0)}#r=P(qt({}));get steps(){return V(this.#r)}set steps(e){F(this.#r,e,!0)}#i=P(``);get chosen(){return V(this.#i)}set chosen(e){F(this.#i,e,!0)}#a=P(null);get held(){return V(this.#a)}set held(e){F(this.#a,e,!0)}#o=P(``);get why(){return V(this.#o)}set why(e){F(this.#o,e,!0)}#s=P(null);get came(){return V(this.#s)}set came(e){F(this.#s,e)}#c=P(`idle`);get state(){return V(this.#c)}set state(e){F(this.#c,e,!0)}#l=new dc;#u=null;#d=0;#f=0;#p=()=>void 0;async begin(e){this.state=`beginning`,this.came=this.answer=null,this.why=``;let t=this.#u=new gc(Ji(`/api/benches/{lab}/{bench}/link`,Y.at),Y.session,()=>this.#b(t));await Promise.race([t.opened,new Promise(e=>setTimeout(e,5e3))]),this.#p=Y.listen(e=>this.#v(e));let n=()=>this.#u!==t,r=await X.run([`teleop`,e,`--begin`,`--yes`],e=>{`schema`in e&&e.schema===`pico.steered/v1`&&this.#m(e)});r.exit===0||n()||(oa.wrong(r.diagnostics.filter(e=>e.severity===`error`)),this.#x())}#m(e){this.begun=e,this.#l=new dc,this.steps=Object.fromEntries(Object.entries(e.tunables).map(([e,t])=>[e,t.steps[Math.max(0,t.steps.length-4)]])),this.chosen=Object.keys(e.tunables)[0],this.#d=window.setInterval(()=>this.#h(),_c)}hold(e,t){this.state!==`on`||this.answer?.phase!==`ready`||document.hidden||(this.held={tunable:e,way:t},this.chosen=e,this.why=``,this.#g(this.#l.hold(e,t*this.steps[e])))}release(e){this.begun&&this.held&&(this.held=null,this.why=e,this.#g(this.#l.release()))}size(e){let t=this.begun?.tunables[this.chosen];t&&(this.steps[this.chosen]=hc(t.steps,this.steps[this.chosen],e))}end(){this.release(`it ends`),this.state=`ending`}#h(){let e=this.held||this.answer?.phase!==`ready`||this.state===`ending`;this.#u.waiting||performance.now()-this.#f<(e?0:vc)||this.#g(this.#l.frame(this.state===`ending`))}#g(e){this.#f=performance.now(),this.#u.call(`jog`,this.begun.run,e).then(e=>this.#_(e),e=>{if(!(e instanceof Ki))throw e})}#_(e){this.heard=performance.now(),e.phase!==`over`&&this.state===`beginning`&&(this.state=`on`),this.state!==`beginning`&&(this.#l.heard(e),this.#l.held||(this.held=null),e.phase!==`over`&&(this.answer=e))}#v({kind:e,data:t}){let n=t;e===`run`&&this.begun&&n.run===this.begun.run&&(n.kind===`operation_done`&&n.operation===this.begun.operation&&this.#y(n.data),n.kind===`operation_failed`&&n.operation===this.begun.operation&&this.#y({wrong:[n.data.diagnostic]}),n.kind===`run_finished`&&(this.came=this.came&&{...this.came,outcome:String(n.data.outcome??``)},this.#x(),Promise.all([X.look(),X.recorded()])))}#y(e){let{component:t,robot:n,run:r}=this.begun,i={first:{},last:{},steps:this.answer?.steps??0,refused:0,presses:{},after:0,outcome:``,wrong:[]};this.came={...i,...e,component:t,robot:n,run:r}}#b(e){this.#u===e&&this.state!==`idle`&&(this.held=null,oa.wrong([{severity:`error`,code:`away`,summary:`The line to the bench is lost: nothing moves any more.`,hint:this.begun?.robot?`${this.begun.robot} may still hold ${this.begun.component}: \`pico recover\` sets it down`:``}]),this.#x())}#x(){let e=this.#u;this.state=`idle`,this.begun=this.answer=this.held=this.#u=null,clearInterval(this.#d),this.#p(),e?.close()}watch(){let e=()=>{document.hidden&&this.release(`the tab was hidden`)},t=()=>this.release(`the window lost the focus`),n=()=>this.release(`the page was left`);return addEventListener(`blur`,t),addEventListener(`pagehide`,n),document.addEventListener(`visibilitychange`,e),document.addEventListener(`freeze`,n),()=>{removeEventListener(`blur`,t),removeEventListener(`pagehide`,n),document.removeEventListener(`visibilitychange`,e),document.removeEventListener(`freeze`,n)}}},bc=U(`<option> </option>`),xc=U(`<option>all that motors and electronics set</option>`),Sc=U(`<option>x, y, yaw in the arm's hand</option>`),Cc=U(`<p class="dim">Move what a motor sets, or a part in the arm's hand, by a key or button that is held. Let go and it stops within 0.2 s; so it does where the window loses the focus, the tab is hidden or the line breaks.</p> <div class="form svelte-1twg5s6"><label for="steered">Component</label> <select id="steered"></select> <label for="by">What of it</label> <select id="by"><!><!><!></select></div> <div class="row"><!></div> <!>`,1),wc=U(`<br/><span class="dim"> </span>`,1),Tc=U(`<p class="note warn"> </p>`),Ec=U(`<meter class="svelte-1twg5s6"> </meter> <div class="row dim ends number svelte-1twg5s6"><span> </span><span class="grow"></span><span> </span></div>`,1),Dc=U(`<div><div class="row"><span class="mono grow cut"> </span><output class="number value svelte-1twg5s6"> </output></div> <!> <div class="row"><!> <label class="hidden"> </label> <select class="grow"></select> <!></div></div>`),Oc=U(`<section class="keys svelte-1twg5s6" role="application" tabindex="0"><div class="row"><h2 class="mono"> </h2><span class="dim grow cut"> </span> <!></div> <div><span class="lamp svelte-1twg5s6" aria-hidden="true"></span> <span class="grow"><strong role="status"> </strong><!></span> <span class="number dim" title="How long ago the bench's edge last heard this page, and answered"> </span></div> <!> <!> <p class="dim small svelte-1twg5s6"> </p></section> <!>`,1),kc=U(`<tr><th scope="row" class="mono svelte-1twg5s6"> </th><td class="number"> </td></tr>`),Ac=U(`<div class="row"><!></div> <!>`,1),jc=U(`<div class="row wrap svelte-1twg5s6"><!> <!></div> <!><!>`,1),Mc=U(`<section class="note svelte-1twg5s6" aria-label="What it came to"><h2> </h2> <!> <table class="svelte-1twg5s6"><tbody></tbody></table> <p class="dim small svelte-1twg5s6"> <!></p> <!></section>`),Nc=U(`<p> </p> <p class="dim">Stay at this page: an arm on its way stops where nobody is heard for 0.2 s.</p> <!> <div class="row"><button class="main" data-first="">Take it in hand</button><button>Leave it</button></div>`,1),Pc=U(`<!> <!> <!>`,1);function Fc(e,t){Ve(t,!0);let n={ArrowLeft:[`x`,-1],ArrowRight:[`x`,1],ArrowDown:[`y`,-1],ArrowUp:[`y`,1],PageUp:[`yaw`,1],PageDown:[`yaw`,-1]},r=P(!1),i=P(0),a=``,o=e=>Object.entries(e.tunables??{}).filter(([,e])=>e.datatype===`float`&&[`motor`,`electronics`].includes(e.mover)).map(([e])=>e),s=N(()=>(Y.scene?.components??[]).filter(e=>e.type&&(o(e).length||e.movable))),c=N(()=>V(s).find(e=>e.name===Gi.now.query.part)??V(s)[0]),l=N(()=>V(c)?o(V(c)):[]),u=P(``),d=N(()=>[...V(l),`pose`].includes(V(u))?V(u):V(l).length?``:`pose`),f=N(()=>V(c)?`${V(c).name}${V(d)?`.${V(d)}`:``}`:``),p=N(()=>Y.barred??(aa.may(`teleop`,Y.lab)?V(f)?null:`nothing here can be steered`:`steering needs the role teleop`)),h=N(()=>yc.begun),g=N(()=>yc.answer),_=N(()=>Math.max(0,V(i)-yc.heard)),v=N(()=>yc.state===`on`&&V(g)?.phase===`ready`),y=N(()=>yc.state===`beginning`?V(g)?.phase===`taking`?`the arm takes it in hand …`:`beginning …`:yc.state===`ending`?V(h)?.robot?`the arm sets it down …`:`ending …`:V(g)?.phase===`taking`?`the arm takes it in hand …`:yc.held?`moving`:`still`),b=N(()=>yc.held?``:[V(g)&&pc(V(g)),yc.why].filter(Boolean).join(`; `));Bi(()=>{let e=yc.watch(),t=setInterval(()=>F(i,performance.now(),!0),100);return()=>{yc.release(`the panel was left`),e(),clearInterval(t)}});function x(){F(r,!1),yc.begin(V(f))}function S(e){if(e.ctrlKey||e.metaKey||e.altKey||e.target.matches(`input, select`))return;let t=V(h)?.robot?n[e.key]:e.key===`ArrowLeft`||e.key===`ArrowRight`?[yc.chosen,e.key===`ArrowRight`?1:-1]:null;if(t){if(e.preventDefault(),e.repeat||a)return;a=e.key,yc.hold(t[0],t[1])}else if([`+`,`=`,`-`,`_`].includes(e.key))yc.size(`+=`.includes(e.key)?1:-1);else if(e.key===`q`)yc.end();else if(!V(h)?.robot&&(e.key===`ArrowDown`||e.key===`ArrowUp`)){e.preventDefault();let t=Object.keys(V(h)?.tunables??{});yc.chosen=t[(t.indexOf(yc.chosen)+(e.key===`ArrowDown`?1:-1)+t.length)%t.length]}}function C(e){e.key===a&&(a=``,yc.release(`the key was let go`))}function w(){a&&yc.release(document.hasFocus()?`the keys went elsewhere`:`the window lost the focus`),a=``}async function T(){await X.move([`recover`,`--yes`])===0&&yc.came&&(yc.came={...yc.came,wrong:[]})}function E(e){e.focus()}var D=Pc(),O=L(D),ee=e=>{var t=Cc(),n=z(L(t),2),i=z(I(n),2);q(i,21,()=>V(s),Gr,(e,t)=>{var n=bc(),r=R(n,!0),i={};B(()=>{G(r,V(t).name),i!==(i=V(t).name)&&(n.__value=i)}),W(e,n)}),A(i);var a;vi(i);var o=z(i,4),m=I(o),h=e=>{var t=xc();t.value=t.__value=``,W(e,t)};K(m,e=>{V(l).length>1&&e(h)});var g=z(m);q(g,17,()=>V(l),Gr,(e,t)=>{var n=bc(),r=R(n),i={};B(()=>{G(r,`${V(t)??``}${V(c)?.tunables[V(t)]?.unit?` [${V(c).tunables[V(t)].unit}]`:``}`),i!==(i=V(l).length>1?V(t):``)&&(n.value=(n.__value=i)??``)}),W(e,n)});var _=z(g),v=e=>{var t=Sc();t.value=t.__value=`pose`,W(e,t)};K(_,e=>{V(c)?.movable&&e(v)}),A(o);var y;vi(o),A(n);var b=z(n,2);lo(I(b),{main:!0,get barred(){return V(p)},run:()=>{V(d)===`pose`?F(r,!0):x()},children:(e,t)=>{Ce();var n=Mr();B(()=>G(n,yc.state===`beginning`?`Beginning …`:`Begin`)),W(e,n)},$$slots:{default:!0}}),A(b);var S=z(b,2);{let e=N(()=>[`teleop`,V(f)]);ko(S,{get words(){return V(e)}})}B(()=>{a!==(a=V(c)?.name)&&(i.value=(i.__value=a)??``,_i(i,a)),y!==(y=V(d))&&(o.value=(o.__value=y)??``,_i(o,y))}),H(`change`,i,e=>Gi.set({part:e.currentTarget.value})),H(`change`,o,e=>F(u,e.currentTarget.value,!0)),W(e,t)},k=e=>{var t=Oc(),n=L(t),r=I(n),i=I(r),a=R(i,!0),o=z(i),s=R(o,!0),c=z(o,2);{let e=N(()=>yc.state===`ending`?`it ends`:null);lo(c,{small:!0,main:!0,run:()=>yc.end(),get barred(){return V(e)},children:(e,t)=>{Ce();var n=Mr();B(()=>G(n,V(h).robot?`Set it down`:`Done`)),W(e,n)},$$slots:{default:!0}})}A(r);var l=z(r,2);let u;var d=z(I(l),2),f=I(d),p=R(f,!0),x=z(f),T=e=>{var t=wc(),n=R(z(L(t)));B(()=>G(n,`stopped: ${V(b)??``}`)),W(e,t)};K(x,e=>{V(b)&&e(T)}),A(d);var D=R(z(d,2));A(l);var O=z(l,2),ee=e=>{var t=Tc(),n=R(t,!0);B(()=>G(n,V(g).limit)),W(e,t)};K(O,e=>{V(g)?.limit&&e(ee)});var k=z(O,2);q(k,17,()=>Object.entries(V(h).tunables),([e,t])=>e,(e,t)=>{var n=N(()=>m(V(t),2));let r=()=>V(n)[0],i=()=>V(n)[1],a=N(()=>V(g)?.values[r()]),o=N(()=>yc.steps[r()]??i().longest);var s=Dc();let c;var l=I(s),u=I(l),d=R(u,!0),f=z(u),p=R(f);A(l);var h=z(l,2),_=e=>{var t=Ec(),n=L(t),o=R(n,!0),s=z(n,2),c=I(s),l=R(c,!0),u=R(z(c,2));A(s),B((e,t)=>{J(n,`min`,i().range[0]),J(n,`max`,i().range[1]),Di(n,V(a)??i().range[0]),J(n,`aria-label`,`${r()??``} within its limits`),G(o,V(a)),G(l,e),G(u,`${t??``} ${i().unit??``}`)},[()=>xo(i().range[0]),()=>xo(i().range[1])]),W(e,t)};K(h,e=>{i().range&&e(_)});var b=z(h,2),x=I(b);{let e=N(()=>V(v)?null:V(y));cc(x,{get label(){return`${r()??``} less`},get barred(){return V(e)},hold:()=>yc.hold(r(),-1),release:()=>yc.release(`the button was let go`),children:(e,t)=>{Ce(),W(e,Mr(`−`))},$$slots:{default:!0}})}var S=z(x,2),C=R(S),w=z(S,2);q(w,21,()=>i().steps,Gr,(e,t)=>{var n=bc(),r=R(n),a={};B(e=>{G(r,`step ${e??``} ${i().unit??``}`),a!==(a=V(t))&&(n.value=(n.__value=a)??``)},[()=>xo(V(t),6)]),W(e,n)}),A(w);var T;vi(w);var E=z(w,2);{let e=N(()=>V(v)?null:V(y));cc(E,{get label(){return`${r()??``} more`},get barred(){return V(e)},hold:()=>yc.hold(r(),1),release:()=>yc.release(`the button was let go`),children:(e,t)=>{Ce(),W(e,Mr(`+`))},$$slots:{default:!0}})}A(b),A(s),B(e=>{c=fi(s,1,`one svelte-1twg5s6`,null,c,{chosen:yc.chosen===r()}),G(d,r()),J(f,`aria-label`,`${r()??``} stands at`),G(p,`${e??``} ${i().unit??``}`),J(S,`for`,`step-${r()??``}`),G(C,`Step of ${r()??``}`),J(w,`id`,`step-${r()??``}`),T!==(T=V(o))&&(w.value=(w.__value=T)??``,_i(w,T))},[()=>mc(V(a),V(o))]),H(`change`,w,e=>{yc.steps[r()]=Number(e.currentTarget.value),yc.chosen=r()}),W(e,s)});var te=R(z(k,2));A(n),ri(n,e=>E?.(e));var ne=z(n,2);{let e=N(()=>[`teleop`,`${V(h).component}${V(h).robot?`.pose`:Object.keys(V(h).tunables).length===1?`.${Object.keys(V(h).tunables)[0]}`:``}`]);ko(ne,{get words(){return V(e)}})}B(e=>{J(n,`aria-label`,`Steering ${V(h).component??``} by keys`),G(a,V(h).component),G(s,V(h).robot?`in the hand of ${V(h).robot}`:`by its motors`),u=fi(l,1,`man svelte-1twg5s6`,null,u,{alive:V(_)<500,moves:yc.held}),G(p,V(y)),G(D,`heard ${e??``} s ago`),G(te,`While this box has the focus: ${V(h).robot?`arrows x and y, Page Up and Down yaw`:`← → move, ↑ ↓ choose`}, + − step, q ends.`)},[()=>(V(_)/1e3).toFixed(1)]),H(`keydown`,n,S),H(`keyup`,n,C),H(`focusout`,n,w),W(e,t)};K(O,e=>{V(h)?e(k,-1):e(ee)});var te=z(O,2),ne=e=>{let t=N(()=>yc.came);var n=Mc(),r=I(n),i=R(r),a=z(r,2);Ps(a,{get found(){return V(t).wrong}});var o=z(a,2),s=I(o);q(s,21,()=>Object.keys(V(t).last),Gr,(e,n)=>{var r=kc(),i=I(r),a=R(i,!0),o=R(z(i));A(r),B((e,t)=>{G(a,V(n)),G(o,`${e??``} → ${t??``}`)},[()=>xo(V(t).first[V(n)]??NaN,4),()=>xo(V(t).last[V(n)],4)]),W(e,r)}),A(s),A(o);var c=z(o,2),l=I(c),u=z(l),d=e=>{var n=Mr();B(e=>G(n,` The longest that anything moved after the last frame of a press: ${e??``} ms.`),[()=>Math.round(V(t).after*1e3)]),W(e,n)};K(u,e=>{V(t).after&&e(d)}),A(c);var f=z(c,2),p=e=>{var t=Ac(),n=L(t);lo(I(n),{main:!0,run:T,get barred(){return Y.barred},title:`Sets down what the arm still holds, and parks it`,children:(e,t)=>{Ce(),W(e,Mr(`Recover`))},$$slots:{default:!0}}),A(n),ko(z(n,2),{words:[`recover`]}),W(e,t)},m=e=>{var t=jc(),n=L(t),r=I(n);lo(r,{run:()=>X.wrote([`capture`]),get barred(){return Y.barred},children:(e,t)=>{Ce(),W(e,Mr(`Write it into the manifest`))},$$slots:{default:!0}}),lo(z(r,2),{run:()=>X.move([`undo`,`--yes`]),get barred(){return Y.barred},children:(e,t)=>{Ce(),W(e,Mr(`Go back`))},$$slots:{default:!0}}),A(n);var i=z(n,2);ko(i,{words:[`capture`]}),ko(z(i),{words:[`undo`]}),W(e,t)};K(f,e=>{V(t).robot&&V(t).wrong.length?e(p):e(m,-1)}),A(n),B(()=>{G(i,`${V(t).component??``}: ${V(t).steps??``} step${V(t).steps===1?``:`s`}${V(t).outcome&&V(t).outcome!==`done`?`, ${V(t).outcome}`:``}`),G(l,`One transition of run ${V(t).run??``}.`)}),W(e,n)};K(te,e=>{yc.came&&!V(h)&&e(ne)});var re=z(te,2),ie=e=>{{let t=N(()=>V(c)?.name);uc(e,{get title(){return`Take ${V(t)??``} in hand?`},close:()=>F(r,!1),children:(e,t)=>{var n=Nc(),i=L(n),a=R(i),o=z(i,4);{let e=N(()=>[`teleop`,V(f)]);ko(o,{get words(){return V(e)}})}var s=z(o,2),l=I(s),u=z(l);A(s),B(()=>G(a,`The arm takes ${V(c)?.name??``} where it stands, lifts it by 3 mm and holds it there. Lasers that can be shut are shut meanwhile, and stay shut afterwards. When you are done the arm sets it down where it is then.`)),H(`click`,l,x),H(`click`,u,()=>F(r,!1)),W(e,n)},$$slots:{default:!0}})}};K(re,e=>{V(r)&&e(ie)}),W(e,D),He()}Sr([`change`,`keydown`,`keyup`,`focusout`,`click`]);var Ic=U(`<button class="small svelte-etlis4"> </button>`),Lc=U(`<div class="choice svelte-etlis4" role="group" aria-label="What to do"></div> <!>`,1);function Rc(e,t){Ve(t,!0);let n={steer:Fc,measure:os,optimize:ks,recipes:oc},r=N(()=>(Gi.now.query.act??``)in n?Gi.now.query.act:`steer`),i=N(()=>n[V(r)]);var a=Lc(),o=L(a);q(o,21,()=>Object.keys(n),Gr,(e,t)=>{var n=Ic(),i=R(n,!0);B(e=>{J(n,`aria-pressed`,V(r)===V(t)),G(i,e)},[()=>V(t)[0].toUpperCase()+V(t).slice(1)]),H(`click`,n,()=>Gi.set({act:V(t)})),W(e,n)}),A(o),ti(z(o,2),()=>V(i),(e,t)=>{t(e,{})}),W(e,a),He()}Sr([`click`]);var zc=U(` <!>`,1),Bc=U(`<button class="small main"> </button>`),Vc=U(`<!> <!>`,1),Hc=U(`<button class="small bare" aria-label="Close">✕</button>`),Uc=U(`<div class="row again svelte-13xw9o8"><span class="dim grow"> </span><!></div>`),Wc=U(`<pre class="svelte-13xw9o8"> </pre>`),Gc=U(`<section aria-label="Progress" class="svelte-13xw9o8"><div class="row"><code class="cut svelte-13xw9o8"> </code> <progress class="grow svelte-13xw9o8" max="1" aria-label="Progress"></progress> <span class="number cut" role="status"><!><span> </span></span> <!> <!> <!> <button class="small bare">Log</button> <!></div> <!> <!> <!></section>`);function Kc(e,t){Ve(t,!0);let n=P(!1),r=N(()=>X.going),i=N(()=>Object.values(V(r)?.steps??{})),a=N(()=>V(i).filter(e=>e.state===`done`).length),o=N(()=>V(i).length?V(i).reduce((e,t)=>e+t.fraction,0)/V(i).length:0),s=N(()=>V(r)?.plan?.operations.filter(e=>V(r).steps[e.id]?.state===`going`)??[]),c=N(()=>V(r)?.exit??null),l=N(()=>X.question?`asks: ${X.question.text}`:V(c)===null?V(s).map(e=>`${e.component}: ${V(r)?.steps[e.id]?.phase||e.primitive}${wo(e,V(r)?.steps[e.id]?.took??0)?`, late: ${Co(V(r)?.steps[e.id]?.took??0)} of about ${Co(e.seconds)}`:``}`).join(`, `)||`beginning …`:V(r)?.report?`${V(r).report.outcome}: ${V(r).report.done} done${V(r).report.failed?`, ${V(r).report.failed} failed`:``}, ${Co(V(r).report.seconds)}`:V(c)===0?`done`:`ended with exit code ${V(c)}`),u=N(()=>V(r)?.events.find(e=>e.operation)?.time??0),d=N(()=>Math.max(0,(V(r)?.events.at(-1)?.time??V(u))-V(u))),f=[`interrupted`,`failed`,`killed`],p=N(()=>X.runs.find(e=>e.id===V(r)?.events.at(-1)?.run)),m=N(()=>V(c)===null?null:[V(r)?.report,V(p)].find(e=>e&&f.includes(e.outcome))??null),h=N(()=>(Y.scene?.components??[]).filter(e=>e.state===`held`).map(e=>[e.held_by??`a hand`,e.name])),g=(e,t)=>`${e.toFixed(1).padStart(7)} s  ${t}`;var _=Nr(),v=L(_),y=e=>{var t=Gc(),s=I(t),u=I(s),f=R(u,!0),p=z(u,2),_=z(p,2),v=I(_),y=e=>{var t=zc(),n=L(t),o=z(n),s=e=>{var t=Mr();B((e,n)=>G(t,`${e??``} of ${n??``} · `),[()=>V(d).toFixed(0),()=>Co(V(r).plan.makespan)]),W(e,t)};K(o,e=>{V(c)===null&&V(r).plan&&e(s)}),B(()=>G(n,`${V(a)??``}/${V(i).length??``} · `)),W(e,t)};K(v,e=>{V(i).length&&e(y)});var b=z(v),x=R(b,!0);A(_);var S=z(_,2),C=e=>{var t=Bc(),n=R(t,!0);B(()=>G(n,X.mayAnswer?`See`:`Answer`)),H(`click`,t,()=>Gi.go(`do`,{act:`recipes`})),W(e,t)};K(S,e=>{X.question&&e(C)});var w=z(S,2),T=e=>{lo(e,{small:!0,run:()=>X.cancel(),title:`Nothing more starts, and a part in the hand is set down; Resume goes on from there`,children:(e,t)=>{Ce(),W(e,Mr(`Halt`))},$$slots:{default:!0}})};K(w,e=>{V(c)===null&&e(T)});var E=z(w,2),D=e=>{var t=Vc(),n=L(t);lo(n,{small:!0,main:!0,get barred(){return Y.barred},run:()=>X.move([`resume`,`--yes`]),title:`Looks, plans from there to the same goal, repeats nothing`,children:(e,t)=>{Ce(),W(e,Mr(`Resume`))},$$slots:{default:!0}});var r=z(n,2),i=e=>{{let t=N(()=>V(h).map(([e,t])=>`${e} ${t}`).join(`, `));lo(e,{small:!0,get barred(){return Y.barred},run:()=>X.move([`recover`,`--yes`]),get title(){return`Sets down what hands still hold: ${V(t)??``}`},children:(e,t)=>{Ce(),W(e,Mr(`Recover`))},$$slots:{default:!0}})}};K(r,e=>{V(h).length&&e(i)}),W(e,t)};K(E,e=>{V(m)&&e(D)});var O=z(E,2),ee=z(O,2),k=e=>{var t=Hc();H(`click`,t,()=>X.going=null),W(e,t)};K(ee,e=>{V(c)!==null&&e(k)}),A(s);var te=z(s,2),ne=e=>{var t=Uc(),n=I(t),r=R(n);ko(z(n),{words:[`resume`]}),A(t),B(e=>G(r,`Cut short: Resume goes on to ${V(m).goal??``}${e??``}.`),[()=>V(h).length?`; ${V(h).map(([e,t])=>`${e} holds ${t}`).join(`, `)}, Recover sets it down`:``]),W(e,t)};K(te,e=>{V(m)&&e(ne)});var re=z(te,2),ie=e=>{{let t=N(()=>V(r).diagnostics.filter(e=>e.severity===`error`));Ps(e,{get found(){return V(t)}})}};K(re,e=>{V(c)&&e(ie)});var ae=z(re,2),oe=e=>{var t=Wc(),n=R(t,!0);B(e=>G(n,e),[()=>V(r).events.filter(e=>e.kind!==`operation_progress`).map(e=>g(e.time,`${e.kind.replaceAll(`_`,` `)} ${e.component??``} ${e.operation??``}`)).join(`
`)]),W(e,t)};K(ae,e=>{V(n)&&e(oe)}),A(t),B(e=>{G(f,e),Di(p,V(c)===0?1:V(o)),fi(b,1,oi(V(c)===null?``:V(c)===0?`ok`:`bad`)),G(x,V(l)),J(O,`aria-expanded`,V(n))},[()=>po(V(r).words)]),H(`click`,O,()=>F(n,!V(n))),W(e,t)};K(v,e=>{V(r)&&e(y)}),W(e,_),He()}Sr([`click`]);var qc=new class{#e=P(null);get phantom(){return V(this.#e)}set phantom(e){F(this.#e,e)}#t=P([]);get ghosts(){return V(this.#t)}set ghosts(e){F(this.#t,e)}#n=P([]);get outlined(){return V(this.#n)}set outlined(e){F(this.#n,e)}};function Jc(e,t){if(typeof e==`string`)return Yc(e,t);let n=e??{};return n.x===void 0?n.pose??(n.slot?Yc(n.slot,t):null):n}function Yc(e,t){let n=t.table.slots.find(t=>t.name===e);return n?{x:n.x,y:n.y,yaw:n.yaw}:null}function Xc(e,t,n=null){return e.operations.flatMap((e,r)=>{if(n!==null&&e.id!==n)return[];let i=t.components.find(t=>t.name===e.component),a=e.primitive===`move`?Jc(e.arguments.to,t):null;return!i||!a?[]:[{part:i.index,...a,label:String(r+1),tone:e.reason.kind===`changed`?`to`:`staged`}]})}function Zc(e,t){return e.filter(e=>e.tunable===`pose`).flatMap(e=>{let n=t.components.find(t=>t.name===e.component);return n?[[e.before,`from`,`A`],[e.after,`to`,`B`]].flatMap(([e,r,i])=>{let a=Jc(e,t);return a?[{part:n.index,...a,label:i,tone:r}]:[]}):[]})}function Qc(e,t){let n=new Set(e.flatMap(e=>`${e.address??``} ${e.summary} ${e.detail??``}`.split(/[^a-z0-9_]+/)));return t.components.map(e=>e.name).filter(e=>n.has(e))}var $c=U(`<p class="note warn"> </p>`),el=jr(`<path class="svelte-1eajku7"></path>`),tl=U(`<span class="badge">A</span>&nbsp;`,1),nl=U(`<span class="badge accent">B</span>&nbsp;`,1),rl=U(`<span class="badge accent"> </span>`),il=U(`<span class="badge ok">here</span>`),al=U(`<span class="badge"> </span>`),ol=U(`<li><svg aria-hidden="true" class="svelte-1eajku7"><!><!><circle r="5"></circle></svg> <button data-row="" class="grow svelte-1eajku7"><span class="cut line svelte-1eajku7"><!> </span> <span class="line under svelte-1eajku7"><!> <!> <!> <span class="dim cut"> </span></span></button></li>`),sl=U(`<li class="dim none svelte-1eajku7"> </li>`),cl=U(`<h2> </h2>`),ll=U(`<h2> </h2><p class="dim"> </p>`,1),ul=U(`<tr><th scope="row" class="svelte-1eajku7"><b class="mono" aria-hidden="true"> </b> <button class="small bare mono svelte-1eajku7"> </button></th><td class="svelte-1eajku7"> </td><td class="dim number svelte-1eajku7"> </td></tr>`),dl=U(`<tr><td class="dim svelte-1eajku7"> </td></tr>`),fl=U(`<button> </button>`),pl=U(`<form class="row wrap svelte-1eajku7"><label class="hidden" for="called"> </label> <input id="called" class="grow" autocomplete="off"/> <!></form> <!>`,1),ml=U(`<div class="row wrap svelte-1eajku7"><button class="main">Plan it</button> <!> <!></div> <!> <!>`,1),hl=U(`<section class="note svelte-1eajku7"><!> <table class="svelte-1eajku7"><tbody></tbody></table> <!></section>`),gl=U(`<p class="dim" role="status">Planning …</p>`),_l=U(`<br/> `,1),vl=U(`<li><b class="mono" aria-hidden="true"> </b> <span class="mono"> </span> </li>`),yl=U(`<p> <!></p> <ul class="plain moves svelte-1eajku7"></ul>`,1),bl=U(`<p> </p> <!> <!> <div class="row wrap svelte-1eajku7"><button class="main" data-first="">Files and bench</button> <button>Files only</button> <button>Leave it</button></div>`,1),xl=U(`<label class="hidden" for="find">Search commits</label> <input id="find" type="search" placeholder="Search: message, name, author" autocomplete="off"/> <!> <ol class="plain svelte-1eajku7" aria-label="Commits"></ol> <p class="dim small svelte-1eajku7">Ctrl and click (or Enter) on a second commit compares the two.</p> <!> <!>`,1);function Sl(e,t){Ve(t,!0);let n=[`#1f8fff`,`#d98e04`,`#2fa35a`,`#b65cd6`,`#e0564d`,`#16a3a3`],r=P(``),i=P(null),a=P(null),o=P(``),s=N(()=>X.log?.commits??[]),c=N(()=>V(s).find(e=>p(e)===Gi.now.query.from)??null),l=N(()=>V(s).find(e=>p(e)===Gi.now.query.to)??null),u=N(()=>(1+Math.max(0,...V(s).map(e=>Math.max(e.lane??0,...(e.links??[]).flat()))))*14+6),d=N(()=>(X.status?.rows??[]).filter(e=>e.edited).length),f=e=>!V(r)||`${e.message} ${e.refs.join(` `)} ${e.author} ${e.id}`.toLowerCase().includes(V(r).toLowerCase());function p(e){return e.refs[0]??e.id.slice(0,9)}let h=e=>e*14+9,g=e=>n[e%n.length],_=N(()=>[`git`,V(a)??``,V(o).trim(),...V(l)?[V(l).id.slice(0,12)]:[]]),v=N(()=>aa.may(`operator`,Y.lab)?V(o).trim()?/^[A-Za-z0-9][\w./-]*$/.test(V(o).trim())?null:"letters, digits, `.`, `/`, `_` and `-`":`say what it is to be called`:`needs the role operator`);async function y(){await X.did(V(_))&&(F(a,null),F(o,``))}function b(e){F(i,e,!0),X.think([`plan`,p(e)])}function x(e,t){(t.ctrlKey||t.metaKey)&&V(l)&&V(l)!==e?Gi.set({from:p(V(l)),to:p(e)}):Gi.set({from:null,to:p(e)})}_n(()=>{let e=V(c)&&V(l)?[p(V(c)),p(V(l))]:null;fr(()=>{e?X.compare(...e):X.diff=null})}),_n(()=>{let e=V(c)?X.diff?.changes:V(l)?.changes;return qc.ghosts=Y.scene&&e?Zc(e,Y.scene):[],()=>{qc.ghosts=[]}});var S=xl(),C=z(L(S),2);Ei(C);var w=z(C,2),T=e=>{var t=$c(),n=R(t);B(()=>G(n,`${V(d)??``} value${V(d)===1?``:`s`} of the manifest ${V(d)===1?`is`:`are`} edited and in no commit.`)),W(e,t)};K(w,e=>{V(d)&&e(T)});var E=z(w,2);q(E,23,()=>V(s),e=>e.id,(e,t,n)=>{var r=ol();let i;var a=I(r);J(a,`height`,44);var o=I(a);q(o,17,()=>V(t).links??[],Gr,(e,t)=>{var n=N(()=>m(V(t),2));let r=()=>V(n)[0],i=()=>V(n)[1];var a=el();B((e,t,n,r,i)=>{J(a,`d`,`M${e??``} 22 C${t??``} 44 ${n??``} 22 ${r??``} 44`),J(a,`stroke`,i)},[()=>h(r()),()=>h(r()),()=>h(i()),()=>h(i()),()=>g(Math.max(r(),i()))]),W(e,a)});var d=z(o);q(d,17,()=>V(s)[V(n)-1]?.links??[],Gr,(e,t)=>{var n=N(()=>m(V(t),2));let r=()=>V(n)[1];var i=el();B((e,t)=>{J(i,`d`,`M${e??``} 0 V22`),J(i,`stroke`,t)},[()=>h(r()),()=>g(r())]),W(e,i)});var p=z(d);J(p,`cy`,22);let _;A(a);var v=z(a,2),y=I(v),b=I(y),S=e=>{var t=tl();Ce(),W(e,t)},C=e=>{var t=nl();Ce(),W(e,t)};K(b,e=>{V(t)===V(c)?e(S):V(t)===V(l)&&V(c)&&e(C,1)});var w=z(b,1,!0);A(y);var T=z(y,2),E=I(T);q(E,17,()=>V(t).refs,Gr,(e,t)=>{var n=rl(),r=R(n,!0);B(()=>G(r,V(t))),W(e,n)});var D=z(E,2),O=e=>{W(e,il())};K(D,e=>{V(t).id===X.log?.head&&e(O)});var ee=z(D,2),k=e=>{var n=al(),r=R(n,!0);B(()=>{J(n,`title`,`How far the state is proven: ${V(t).verdict??``}`),G(r,V(t).evidence)}),W(e,n)};K(ee,e=>{V(t).evidence&&e(k)});var te=R(z(ee,2));A(T),A(v),A(r),B((e,n,o,s,d,f)=>{i=fi(r,1,`svelte-1eajku7`,null,i,{faint:e}),J(a,`width`,V(u)),J(p,`cx`,n),J(p,`fill`,o),_=fi(p,0,`svelte-1eajku7`,null,_,{head:V(t).id===X.log?.head}),J(v,`aria-pressed`,V(t)===V(l)||V(t)===V(c)),G(w,s),G(te,`${d??``} ${f??``}`)},[()=>!f(V(t)),()=>h(V(t).lane??0),()=>g(V(t).lane??0),()=>V(t).message.split(`
`)[0],()=>V(t).refs.length?``:V(t).id.slice(0,9),()=>To(V(t).time)]),H(`click`,v,e=>x(V(t),e)),H(`keydown`,v,e=>{e.key===`Enter`&&(e.ctrlKey||e.metaKey)&&(e.preventDefault(),x(V(t),e))}),W(e,r)},e=>{var t=sl(),n=R(t,!0);B(e=>G(n,e),[()=>X.busy.some(e=>e.startsWith(`log`))?`Reading …`:`No commit yet.`]),W(e,t)}),A(E),ri(E,e=>ss?.(e));var D=z(E,4),O=e=>{var t=hl(),n=I(t),r=e=>{var t=cl(),n=R(t);B((e,t)=>G(n,`${e??``} → ${t??``}`),[()=>p(V(c)),()=>p(V(l))]),W(e,t)},i=e=>{var t=ll(),n=L(t),r=R(n,!0),i=R(z(n));B((e,t,n)=>{G(r,e),G(i,`${t??``}, ${n??``}`)},[()=>p(V(l)),()=>V(l).author.replace(/ <.*/,``),()=>To(V(l).time)]),W(e,t)};K(n,e=>{V(c)?e(r):e(i,-1)});var s=z(n,2),u=I(s);q(u,21,()=>(V(c)?X.diff?.changes:V(l).changes)??[],Gr,(e,t)=>{var n=ul(),r=I(n),i=I(r),a=R(i,!0),o=z(i,2),s=R(o);A(r);var l=z(r),u=R(l,!0),d=R(z(l),!0);A(n),B((e,n)=>{G(a,e),G(s,`${V(t).component??``}.${V(t).tunable??``}`),G(u,V(t).text),G(d,n)},[()=>fo(V(t)),()=>V(c)?`${So(V(t).before)} → ${So(V(t).after)}`:``]),H(`click`,o,()=>Gi.go(`inspect`,{part:V(t).component})),W(e,n)},e=>{var t=dl(),n=R(I(t),!0);A(t),B(()=>G(n,V(c)&&!X.diff?`Comparing …`:`Nothing on the table differs.`)),W(e,t)}),A(u),A(s);var d=z(s,2),f=e=>{{let t=N(()=>[`diff`,p(V(c)),p(V(l))]);ko(e,{get words(){return V(t)}})}},m=e=>{var t=ml(),n=L(t),r=I(n),i=z(r,2);{let e=N(()=>V(l).id===X.log?.head?`it is checked out`:Y.barred);lo(i,{run:()=>b(V(l)),get barred(){return V(e)},children:(e,t)=>{Ce(),W(e,Mr(`Check out …`))},$$slots:{default:!0}})}q(z(i,2),16,()=>[`branch`,`tag`],Gr,(e,t)=>{var n=fl(),r=R(n);B(e=>{J(n,`aria-expanded`,V(a)===t),G(r,`${e??``} …`)},[()=>t[0].toUpperCase()+t.slice(1)]),H(`click`,n,()=>F(a,V(a)===t?null:t,!0)),W(e,n)}),A(n);var s=z(n,2),c=e=>{var t=pl(),n=L(t),r=I(n),i=R(r),s=z(r,2);Ei(s),lo(z(s,2),{main:!0,submit:!0,run:y,get barred(){return V(v)},children:(e,t)=>{Ce(),W(e,Mr(`Make it`))},$$slots:{default:!0}}),A(n),ko(z(n,2),{get words(){return V(_)}}),B(e=>{G(i,`Name of the ${V(a)??``}`),J(s,`placeholder`,`Name of the ${V(a)??``} at ${e??``}`)},[()=>p(V(l))]),xr(`submit`,n,e=>{e.preventDefault(),V(v)||y()}),ji(s,()=>V(o),e=>F(o,e)),W(e,t)};K(s,e=>{V(a)&&e(c)});var u=z(s,2);{let e=N(()=>[`show`,p(V(l))]);ko(u,{get words(){return V(e)}})}H(`click`,r,()=>Gi.go(`plan`,{rev:p(V(l))})),W(e,t)};K(d,e=>{V(c)?e(f):e(m,-1)}),A(t),B(()=>J(t,`aria-label`,V(c)?`Comparison`:`Commit`)),W(e,t)};K(D,e=>{V(l)&&e(O)});var ee=z(D,2),k=e=>{{let t=N(()=>p(V(i)));uc(e,{get title(){return`Check out ${V(t)??``}?`},close:()=>F(i,null),children:(e,t)=>{var n=bl(),r=L(n),a=R(r),o=z(r,2),s=e=>{W(e,gl())},c=N(()=>X.busy.some(e=>e.startsWith(`plan`))),l=e=>{var t=yl(),n=L(t);let r;var i=I(n);q(z(i),17,()=>X.plan.diagnostics.filter(e=>e.severity===`error`),Gr,(e,t)=>{var n=_l(),r=z(L(n),1,!0);B(()=>G(r,V(t).summary)),W(e,n)}),A(n);var a=z(n,2);q(a,21,()=>X.plan.changes,Gr,(e,t)=>{var n=vl(),r=I(n),i=R(r,!0),a=z(r,2),o=R(a),s=z(a);A(n),B(e=>{G(i,e),G(o,`${V(t).component??``}.${V(t).tunable??``}`),G(s,` ${V(t).text??``}`)},[()=>fo(V(t))]),W(e,n)}),A(a),B((e,t)=>{r=fi(n,1,`note`,null,r,{bad:e}),G(i,`${X.plan.operations.length??``} operations, ${t??``}`)},[()=>X.plan.diagnostics.some(e=>e.severity===`error`),()=>Co(X.plan.makespan)]),W(e,t)},u=N(()=>X.plan&&X.planned[1]===p(V(i)));K(o,e=>{V(c)?e(s):V(u)&&e(l,1)});var d=z(o,2);{let e=N(()=>[`checkout`,p(V(i)),`--yes`]);ko(d,{get words(){return V(e)}})}var f=z(d,2),m=I(f),h=z(m,2),g=z(h,2);A(f),B(e=>G(a,`Files and bench go to ${e??``}: the bench moves. Edits that are not committed are never lost; it is refused where they would be.`),[()=>p(V(i))]),H(`click`,m,()=>{let e=p(V(i));F(i,null),X.move([`checkout`,e,`--yes`])}),H(`click`,h,()=>{let e=p(V(i));F(i,null),X.move([`checkout`,e,`--files-only`,`--yes`])}),H(`click`,g,()=>F(i,null)),W(e,n)},$$slots:{default:!0}})}};K(ee,e=>{V(i)&&e(k)}),ji(C,()=>V(r),e=>F(r,e)),W(e,S),He()}Sr([`click`,`keydown`]);var Cl=U(`<p class="dim" role="status">Reading …</p>`),wl=U(`<button class="small bare" title="Show the commit"><span class="mono"> </span></button> <span class="dim"> </span>`,1),Tl=U(`<span class="dim">edited, in no commit</span>`),El=U(`<li><span class="mono"> </span> <!></li>`),Dl=U(`<li class="dim">The manifest says nothing of it.</li>`),Ol=U(`<li> <span class="dim"> </span></li>`),kl=U(`<li class="dim">Nothing was noted on it.</li>`),Al=U(`<ul class="plain svelte-1sktq7r"></ul> <!> <ul class="plain svelte-1sktq7r"></ul> <form class="row"><label class="hidden" for="note"> </label> <input id="note" class="grow" placeholder="Note: scratched at the rim"/> <!></form>`,1),jl=U(`<details><summary class="svelte-1sktq7r">Who changed it, and notes</summary> <div class="inside svelte-1sktq7r"><!></div></details>`);function Ml(e,t){Ve(t,!0);let n=P(null),r=P(null),i=P(``),a=``,o=N(()=>aa.may(`operator`,Y.lab)?V(i).trim()?null:`say what there is to say`:`needs the role operator`);async function s(){let e=t.name;a=e;let[i,o]=await Promise.all([X.read(`pico.blame/v1`,`blame`,e),X.read(`pico.notes/v1`,`note`,e)]);a===e&&(F(n,i?.leaves??[]),F(r,o?.notes??[]))}async function c(){await X.read(`pico.notes/v1`,`note`,t.name,`--`,V(i).trim())&&(F(i,``),await Promise.all([s(),X.look()]))}var l=jl(),u=z(I(l),2),d=I(u),f=e=>{W(e,Cl())},p=e=>{var a=Al(),s=L(a);q(s,21,()=>V(n),e=>e.tunable,(e,t)=>{var n=El(),r=I(n),i=R(r,!0),a=z(r,2),o=e=>{var n=wl(),r=L(n),i=R(I(r),!0);A(r);var a=z(r),o=R(z(a));B(e=>{G(i,V(t).last.name),G(a,` ${V(t).last.text??``} `),G(o,`${V(t).last.author??``}, ${e??``}: ${V(t).last.summary??``}`)},[()=>To(V(t).last.time)]),H(`click`,r,()=>Gi.go(`history`,{to:V(t).last.name,from:``})),W(e,n)},s=e=>{W(e,Tl())};K(a,e=>{V(t).last?e(o):e(s,-1)}),A(n),B(()=>G(i,V(t).tunable)),W(e,n)},e=>{W(e,Dl())}),A(s);var l=z(s,2);{let e=N(()=>[`blame`,t.name]);ko(l,{get words(){return V(e)}})}var u=z(l,2);q(u,21,()=>V(r)??[],Gr,(e,t)=>{var n=Ol(),r=I(n),i=R(z(r));A(n),B(()=>{G(r,`${V(t).text??``} `),G(i,`${V(t).author??``}, ${V(t).day??``}`)}),W(e,n)},e=>{W(e,kl())}),A(u);var d=z(u,2),f=I(d),p=R(f),m=z(f,2);Ei(m),lo(z(m,2),{submit:!0,run:c,get barred(){return V(o)},children:(e,t)=>{Ce(),W(e,Mr(`Note it`))},$$slots:{default:!0}}),A(d),B(()=>G(p,`Note on ${t.name??``}`)),xr(`submit`,d,e=>{e.preventDefault(),V(o)||c()}),ji(m,()=>V(i),e=>F(i,e)),W(e,a)};K(d,e=>{V(n)?e(p,-1):e(f)}),A(u),A(l),xr(`toggle`,l,e=>{e.currentTarget.open&&s()}),W(e,l),He()}Sr([`click`]);var Nl=U(`<li class="mono"><span class="bad"> </span><br/><span class="ok"> </span></li>`),Pl=U(`<details><summary>As Git shows it</summary><pre class="svelte-w8ar4o"> </pre></details>`),Fl=U(`<p class="dim">Not on the bench yet: the commit will say “planned”. Apply it first and the commit carries the run.</p>`),Il=U(`<section class="note svelte-w8ar4o" aria-label="Edits"><h3> </h3> <ul class="plain svelte-w8ar4o"></ul> <!> <!> <label class="hidden" for="message">Message</label> <input id="message" placeholder="Why; what moved without it"/> <!> <div class="row wrap svelte-w8ar4o"><!> <button>Plan it</button></div></section>`);function Ll(e,t){Ve(t,!0);let n=P(``),r=N(()=>(X.status?.rows??[]).filter(e=>e.edited)),i=N(()=>V(r).some(e=>e.off)),a=N(()=>[`commit`,...V(i)?[`--planned`]:[],...mo(V(n).trim())]),o=N(()=>Y.barred&&/role/.test(Y.barred)?Y.barred:null);async function s(){await X.did(V(a))&&F(n,``)}var c=Nr(),l=L(c),u=e=>{var t=Il(),c=I(t),l=R(c),u=z(c,2);q(u,21,()=>V(r),Gr,(e,t)=>{var n=Nl(),r=I(n),i=R(r),a=R(z(r,2));A(n),B((e,n)=>{G(i,`− ${V(t).component??``}.${V(t).tunable??``} ${e??``}`),G(a,`+ ${V(t).component??``}.${V(t).tunable??``} ${n??``}`)},[()=>So(V(t).committed,V(t).unit),()=>So(V(t).desired,V(t).unit)]),W(e,n)}),A(u);var d=z(u,2),f=e=>{var t=Pl(),n=R(z(I(t)),!0);A(t),B(()=>G(n,X.patch)),W(e,t)};K(d,e=>{X.patch&&e(f)});var p=z(d,2),m=e=>{W(e,Fl())};K(p,e=>{V(i)&&e(m)});var h=z(p,4);Ei(h);var g=z(h,2);ko(g,{get words(){return V(a)}});var _=z(g,2),v=I(_);lo(v,{main:!0,run:s,get barred(){return V(o)},children:(e,t)=>{Ce(),W(e,Mr(`Commit`))},$$slots:{default:!0}});var y=z(v,2);A(_),A(t),B(()=>G(l,`${V(r).length??``} edited, in no commit`)),ji(h,()=>V(n),e=>F(n,e)),H(`click`,y,()=>{Gi.go(`plan`,{rev:``}),X.think([`plan`])}),W(e,t)};K(l,e=>{V(r).length&&e(u)}),W(e,c),He()}Sr([`click`]);var Rl=U(`<p class="dim">Choose a component in the list or in the twin.</p> <!>`,1),zl=U(`<span class="badge"> </span>`),Bl=U(`<span class="badge accent">in the hand</span>`),Vl=U(`<span class="badge bad">nobody sees it</span>`),Hl=U(`<p class="dim"> </p>`),Ul=U(`<strong class="warn"> </strong>`),Wl=U(`<strong class="bad"> </strong>`),Gl=U(`<span class="badge" title="Emission and shutters are asked for, never restored by themselves">asked for</span>`),Kl=U(`<tr><th scope="row" class="svelte-1puslgj"> <span class="dim"> </span></th><td class="number svelte-1puslgj"> </td><td class="number svelte-1puslgj"><!></td><td class="number svelte-1puslgj"><!> <!> <!></td><td class="svelte-1puslgj"><button class="small">Edit</button></td></tr>`),ql=U(`<tr><td colspan="5" class="dim svelte-1puslgj">The manifest says nothing of it: it stays at home.</td></tr>`),Jl=U(`<label class="svelte-1puslgj"><span> <span class="dim"> </span></span> <input type="text" inputmode="decimal" class="svelte-1puslgj"/></label>`),Yl=U(`<div class="fields svelte-1puslgj"></div> <div><button type="button" class="small">To the nearest hole</button></div>`,1),Xl=U(`<option> </option>`),Zl=U(`<label class="svelte-1puslgj"> <select></select></label>`),Ql=U(`<label class="svelte-1puslgj"> <span class="dim"> </span> <input type="text" inputmode="decimal" aria-describedby="limits"/></label> <p id="limits" class="dim"> </p>`,1),$l=U(`<p class="bad"> </p>`),eu=U(`<form class="note svelte-1puslgj"><!> <!> <!> <div class="row"><!> <button type="button">Leave it</button></div> <p class="dim">Checked for overlap, reach and limits before it is written. The bench stays until a plan is applied.</p></form>`),tu=U(`<div class="head svelte-1puslgj"><h2 class="mono svelte-1puslgj"> </h2> <!> <!></div> <!> <table class="svelte-1puslgj"><thead class="svelte-1puslgj"><tr><th scope="col" class="svelte-1puslgj">Tunable</th><th scope="col" class="svelte-1puslgj">Committed</th><th scope="col" class="svelte-1puslgj">Desired</th><th scope="col" class="svelte-1puslgj">Live</th><th class="svelte-1puslgj"><span class="hidden">Edit</span></th></tr></thead><tbody class="svelte-1puslgj"></tbody></table> <!> <!> <!>`,1);function nu(e,t){Ve(t,!0);let n=P(null),r=P(qt({})),i=N(()=>Gi.now.query.part??null),a=N(()=>Y.scene?.components.find(e=>e.name===V(i))??null),o=N(()=>(X.status?.rows??[]).filter(e=>e.component===V(i))),s=N(()=>V(o).find(e=>e.tunable===V(n))??null),c=N(()=>V(n)?V(a)?.tunables[V(n)]:void 0),l=N(()=>Object.entries(V(r)).map(([e,t])=>Wo(t,e===`value`?V(c):void 0)).find(Boolean)??null),u=N(()=>V(i)&&V(n)?Ko(V(i),V(n),V(r)):[]),d=N(()=>V(l)??(Y.barred&&/role/.test(Y.barred)?Y.barred:null));function f(e){F(n,e.tunable,!0);let t=e.desired??e.live;e.tunable===`pose`?bo(t)?F(r,{x:String(t.x),y:String(t.y),yaw:String(t.yaw)},!0):V(a)?.pose&&F(r,{x:String(V(a).pose.x),y:String(V(a).pose.y),yaw:String(V(a).pose.yaw)},!0):F(r,{value:String(t??``)},!0)}async function p(){await X.wrote(V(u))&&F(n,null)}function m(){let e=Y.scene?.table.holes;if(e)for(let[t,n]of[`x`,`y`].entries()){let i=e.first[t];V(r)[n]=String(i+e.pitch*Math.round((Number(V(r)[n])-i)/e.pitch))}}_n(()=>{V(i),F(n,null)}),_n(()=>{if(V(a)&&V(n)===`pose`&&!V(l))return qc.ghosts=[{part:V(a).index,x:Number(V(r).x),y:Number(V(r).y),yaw:Number(V(r).yaw),label:``,tone:`to`}],()=>{qc.ghosts=[]}});var h=Nr(),g=L(h),_=e=>{var t=Rl();Ll(z(L(t),2),{}),W(e,t)},v=e=>{var t=tu(),h=L(t),g=I(h),_=R(g,!0),v=z(g,2),y=e=>{var t=zl(),n=R(t,!0);B(e=>G(n,e),[()=>V(a).type.replaceAll(`_`,` `)||`not in the inventory`]),W(e,t)};K(v,e=>{V(a)&&e(y)});var b=z(v,2),x=e=>{W(e,Bl())},S=e=>{W(e,Vl())};K(b,e=>{V(a)?.state===`held`?e(x):V(a)?.state===`lost`&&e(S,1)}),A(h);var C=z(h,2),w=e=>{var t=Hl(),n=R(t,!0);B(()=>G(n,V(a).title)),W(e,t)};K(C,e=>{V(a)?.title&&e(w)});var T=z(C,2),E=z(I(T));q(E,21,()=>V(o),e=>e.tunable,(e,t)=>{var r=Kl(),i=I(r),a=I(i),o=R(z(a),!0);A(i);var s=z(i),c=R(s,!0),l=z(s),u=I(l),d=e=>{var n=Ul(),r=R(n,!0);B(e=>G(r,e),[()=>So(V(t).desired)]),W(e,n)},p=e=>{var n=Mr();B(e=>G(n,e),[()=>So(V(t).desired)]),W(e,n)};K(u,e=>{V(t).edited?e(d):e(p,-1)}),A(l);var m=z(l),h=I(m),g=e=>{var n=Wl(),r=R(n,!0);B(e=>G(r,e),[()=>So(V(t).live)]),W(e,n)},_=e=>{var n=Mr();B(e=>G(n,e),[()=>So(V(t).live)]),W(e,n)};K(h,e=>{V(t).off?e(g):e(_,-1)});var v=z(h,2),y=e=>{W(e,Gl())};K(v,e=>{V(t).requested&&e(y)});var b=z(v,2),x=e=>{var n=Hl(),r=R(n,!0);B(()=>G(r,V(t).note)),W(e,n)};K(b,e=>{V(t).note&&e(x)}),A(m);var S=R(z(m));A(r),B(e=>{G(a,`${V(t).tunable??``} `),G(o,V(t).unit),G(c,e),J(S,`aria-expanded`,V(n)===V(t).tunable),J(S,`aria-label`,`Edit ${V(t).tunable??``}`)},[()=>So(V(t).committed)]),H(`click`,S,()=>V(n)===V(t).tunable?F(n,null):f(V(t))),W(e,r)},e=>{W(e,ql())}),A(E),A(T);var D=z(T,2),O=e=>{var t=eu(),a=I(t),o=e=>{var t=Yl(),n=L(t);q(n,20,()=>[`x`,`y`,`yaw`],Gr,(e,t)=>{var n=Jl(),i=I(n),a=I(i),o=R(z(a),!0);A(i);var s=z(i,2);Ei(s),A(n),B(e=>{G(a,`${t??``} `),G(o,t===`yaw`?`deg`:`mm`),J(s,`aria-invalid`,e)},[()=>Wo(V(r)[t]??``,void 0)?`true`:void 0]),ji(s,()=>V(r)[t],e=>V(r)[t]=e),W(e,n)}),A(n),H(`click`,R(z(n,2)),m),W(e,t)},s=e=>{var t=Zl(),i=I(t),a=z(i);q(a,21,()=>V(c).choices.length?V(c).choices:[`true`,`false`],Gr,(e,t)=>{var n=Xl(),r=R(n,!0),i={};B(()=>{G(r,V(t)),i!==(i=V(t))&&(n.__value=i)}),W(e,n)}),A(a),vi(a),A(t),B(()=>G(i,`${V(n)??``} `)),yi(a,()=>V(r).value,e=>V(r).value=e),W(e,t)},f=e=>{var t=Ql(),i=L(t),a=I(i),o=z(a),s=R(o,!0),u=z(o,2);Ei(u),A(i);var d=R(z(i,2));B(e=>{G(a,`${V(n)??``} `),G(s,V(c)?.unit??``),J(u,`aria-invalid`,V(l)?`true`:void 0),G(d,`${e??``}${V(c)?.description?` · ${V(c).description}`:``}`)},[()=>Go(V(c))]),ji(u,()=>V(r).value,e=>V(r).value=e),W(e,t)};K(a,e=>{V(n)===`pose`?e(o):V(c)?.datatype===`bool`||V(c)?.choices.length?e(s,1):e(f,-1)});var h=z(a,2),g=e=>{var t=$l(),n=R(t,!0);B(()=>G(n,V(l))),W(e,t)};K(h,e=>{V(l)&&e(g)});var _=z(h,2);ko(_,{get words(){return V(u)}});var v=z(_,2),y=I(v);lo(y,{main:!0,submit:!0,run:p,get barred(){return V(d)},children:(e,t)=>{Ce(),W(e,Mr(`Write into the manifest`))},$$slots:{default:!0}});var b=z(y,2);A(v),Ce(2),A(t),B(()=>J(t,`aria-label`,`Edit ${V(i)??``}.${V(n)??``}`)),xr(`submit`,t,e=>{e.preventDefault(),V(d)||p()}),H(`click`,b,()=>F(n,null)),W(e,t)},ee=e=>{{let t=N(()=>[`get`,V(i)]);ko(e,{get words(){return V(t)}})}};K(D,e=>{V(s)&&V(n)?e(O):e(ee,-1)});var k=z(D,2);Wr(k,()=>V(i),e=>{Ml(e,{get name(){return V(i)}})}),Ll(z(k,2),{}),B(()=>G(_,V(i))),W(e,t)};K(g,e=>{V(i)?e(v,-1):e(_)}),W(e,h),He()}Sr([`click`]);var ru=U(`<main class="svelte-1cno08a"><form class="svelte-1cno08a"><h1 class="svelte-1cno08a">PICO</h1> <p>Say who you are, with a code or a token of this coordinator.</p> <label for="secret">Code or token</label> <input id="secret" type="password" autocomplete="off" required=""/> <button class="main" type="submit">Log in</button> <!> <p class="dim">An admin makes a code with <code>pico token invite NAME</code>. On this machine <code>pico gui</code> opens the page for the lab in its folder, logged in.</p></form></main>`);function iu(e,t){Ve(t,!0);let n=P(``);async function r(e){e.preventDefault();let t=V(n).trim();F(n,``),await aa.enter(t.startsWith(`pico_code_`)?{code:t}:{secret:t})}var i=ru(),a=I(i),o=z(I(a),6);Ei(o),Ps(z(o,4),{get found(){return aa.trouble}}),Ce(2),A(a),A(i),xr(`submit`,a,r),ji(o,()=>V(n),e=>F(n,e)),W(e,i),He()}function au(e,t){let[n=0,r=0]=t?.first??[],i=(e,n)=>t?n+t.pitch*Math.round((e-n)/t.pitch):Math.round(e*10)/10,a=Math.round((((e.yaw+180)%360+360)%360-180)*10)/10;return{x:i(e.x,n),y:i(e.y,r),yaw:a===-180?180:a}}function ou(e,t){return[`move`,e,`x=${t.x}`,`y=${t.y}`,`yaw=${t.yaw}`,`--manifest`]}function su({x:e,y:t,yaw:n}){return[e,t,n].map(e=>e.toFixed(3)).join()}function cu({x:e,y:t,yaw:n}){return`x ${e.toFixed(1)}  y ${t.toFixed(1)} mm  ${n.toFixed(1)}°`}var lu=250,uu=new class{#e=P(!1);get on(){return V(this.#e)}set on(e){F(this.#e,e,!0)}#t=P(!0);get snap(){return V(this.#t)}set snap(e){F(this.#t,e,!0)}#n=P(null);get name(){return V(this.#n)}set name(e){F(this.#n,e,!0)}#r=P(null);get pose(){return V(this.#r)}set pose(e){F(this.#r,e)}#i=P(`same`);get checked(){return V(this.#i)}set checked(e){F(this.#i,e,!0)}#a=P([]);get faults(){return V(this.#a)}set faults(e){F(this.#a,e)}#o=P([]);get undo(){return V(this.#o)}set undo(e){F(this.#o,e)}#s=null;#c=[0,0];#l=0;#u=0;get part(){return Y.scene?.components.find(e=>e.name===this.name)??null}get barred(){return aa.may(`operator`,Y.lab)?null:`needs the role operator`}get words(){return this.name&&this.pose?ou(this.name,this.pose):[]}get changed(){return this.pose!==null&&this.#s!==null&&su(this.pose)!==su(this.#s)}get ghost(){return!this.pose||!this.part||!this.changed?null:{part:this.part.index,...this.pose,label:cu(this.pose),tone:this.checked===`wrong`?`bad`:`to`}}turn=()=>{this.on=!this.on,this.on&&Gi.now.query.part?this.take(Gi.now.query.part):this.on||this.leave()};take(e){if(this.barred)return!1;if(this.name===e)return!0;let t=Y.scene?.components.find(t=>t.name===e),n=t&&this.#m(t);return!t||!t.type||t.movable===!1||!n?!1:(this.leave(),this.name=e,this.pose=this.#s=n,!0)}leave(){clearTimeout(this.#l),this.#u++,this.name=this.pose=this.#s=null,this.faults=[],this.checked=`same`}grip(e){this.pose&&(this.#c=[e[0]-this.pose.x,e[1]-this.pose.y])}over(e){this.pose&&this.to(au({...this.pose,x:e[0]-this.#c[0],y:e[1]-this.#c[1]},this.snap?this.#f:null))}to(e){this.pose&&su(e)===su(this.pose)||(this.pose=e,this.faults=[],clearTimeout(this.#l),this.#u++,this.checked=this.changed?`checking`:`same`,this.changed&&(this.#l=window.setTimeout(()=>this.#d(),lu)))}key(e){let t=this.pose;if(!this.on||!t||e.ctrlKey||e.metaKey||e.altKey)return null;let n=e.shiftKey?.1:this.snap?this.#f?.pitch??25:1,r=e.shiftKey?1:15,i=(n,r,i=0)=>()=>this.to(au({x:t.x+n,y:t.y+r,yaw:t.yaw+i},this.snap&&!e.shiftKey&&!i?this.#f:null));return{ArrowLeft:i(-n,0),ArrowRight:i(n,0),ArrowUp:i(0,n),ArrowDown:i(0,-n),r:i(0,0,r),R:i(0,0,r),e:i(0,0,-r),E:i(0,0,-r),Enter:()=>void this.write(),Escape:()=>this.leave()}[e.key]??null}async write(){let e=this.name;if(!e||!this.changed||(clearTimeout(this.#l),this.checked===`checking`&&await this.#d(),this.checked!==`fits`))return;let t=this.#h(e);await X.wrote(this.words)&&(t&&(this.undo=[t,...this.undo].slice(0,50)),this.leave(),this.take(e))}async back(){let[e,...t]=this.undo;if(!e||!await(e[0]===`move`?X.wrote(e):X.did(e)))return;this.undo=t;let n=this.name;this.leave(),n&&this.take(n)}async#d(){let e=++this.#u,t=await X.run([...this.words,`--dry-run`]);e===this.#u&&(this.faults=t.diagnostics.filter(e=>e.severity===`error`),this.checked=t.said.some(e=>`schema`in e&&e.schema===`pico.capture/v1`)&&!this.faults.length?`fits`:`wrong`)}get#f(){return Y.scene?.table.holes??null}#p(e){return X.status?.rows.find(t=>t.component===e&&t.tunable===`pose`)}#m(e){let t=this.#p(e.name)?.desired;return bo(t)&&`x`in t?{x:t.x,y:t.y,yaw:t.yaw}:e.pose?{x:e.pose.x,y:e.pose.y,yaw:e.pose.yaw}:null}#h(e){let t=this.#p(e),n=t?.desired;return t?.edited?bo(n)&&`x`in n?ou(e,n):null:[`checkout`,`HEAD`,`--files-only`,`--yes`,`--`,`${e}.pose`]}},du=[[`steer`,`Steer by hand`],[`measure`,`Measure with a camera`],[`optimize`,`Optimize: seek a goal`],[`recipes`,`Recipes: check and run one`]];function fu(){let e=Y.token!==null;return[{title:`STOP at once`,key:`Ctrl .`,run:()=>void Y.stop()},{title:`Stop safely: nothing more starts`,run:()=>void Y.halt()},...Vi.map((e,t)=>({title:`Show ${e}`,key:String(t+1),run:()=>Gi.go(e)})),...du.map(([e,t])=>({title:t,run:()=>Gi.go(`do`,{act:e})})),{title:`Plan for the manifest`,run:()=>{Gi.go(`plan`,{rev:``}),X.think([`plan`])}},{title:`Look anew (status)`,key:`R`,run:()=>void X.look()},{title:e?`Give the bench back`:`Take the bench`,barred:aa.may(`operator`,Y.lab)?null:`needs the role operator`,run:()=>void(e?Y.release():Y.take())},{title:uu.on?`End editing by hand`:`Edit by hand: drag and turn components`,barred:uu.barred,run:uu.turn},{title:Ao.shown===`dark`?`Light colours`:`Dark colours`,run:Ao.turn},...(Y.scene?.components??[]).map(e=>({title:`Component ${e.name}`,run:()=>Gi.go(`inspect`,{part:e.name})})),...(X.log?.commits??[]).flatMap(e=>e.refs).map(e=>({title:`Plan ${e}`,run:()=>{Gi.go(`plan`,{rev:e}),X.think([`plan`,e])}})),...(X.status&&X.status.backend!==`hardware`?Y.scene?.components??[]:[]).filter(e=>e.movable).map(e=>({title:`Simulator: push ${e.name} by 5 mm`,barred:Y.barred,run:()=>void X.did([`sim`,`nudge`,e.name,`--dx`,`5`])})),{title:`Log out`,run:()=>void aa.leave()}]}function pu(e,t){let n=e.target instanceof HTMLElement&&e.target.matches(`input:not([type=checkbox]), textarea, select`),r=e.ctrlKey||e.metaKey;if(r&&e.key===`.`)return()=>void Y.stop();if(r&&e.key.toLowerCase()===`k`)return t;if(n||r||e.altKey)return null;let i=e.target instanceof HTMLElement&&e.target.closest(e.key===`Enter`?`button, summary, dialog`:`[data-row], [role=tablist], dialog`)?null:uu.key(e);if(i)return i;let a=Vi[Number(e.key)-1];return a?()=>Gi.go(a):e.key===`/`?()=>document.getElementById(`filter`)?.focus():e.key.toLowerCase()===`r`?()=>void X.look():null}var mu=U(`<li><button data-row="" class="svelte-1xmli0s"><span class="grow"> </span><span class="dim"> </span></button></li>`),hu=U(`<li class="dim">Nothing is called so.</li>`),gu=U(`<label class="hidden" for="command">Find a command</label> <input id="command" data-first="" autocomplete="off" placeholder="Find a command, a component, a commit"/> <ul class="plain svelte-1xmli0s"></ul>`,1);function _u(e,t){Ve(t,!0);let n=P(``),r=N(fu),i=N(()=>V(r).filter(e=>V(n).toLowerCase().split(/\s+/).every(t=>e.title.toLowerCase().includes(t))).slice(0,40));function a(e){e&&!e.barred&&(t.close(),e.run())}uc(e,{title:`Commands`,get close(){return t.close},wide:!0,children:(e,t)=>{var r=gu(),o=z(L(r),2);Ei(o);var s=z(o,2);q(s,21,()=>V(i),e=>e.title,(e,t)=>{var n=mu(),r=I(n),i=I(r),o=R(i,!0),s=R(z(i),!0);A(r),A(n),B(()=>{J(r,`aria-disabled`,V(t).barred?`true`:void 0),G(o,V(t).title),G(s,V(t).barred??V(t).key??``)}),H(`click`,r,()=>a(V(t))),W(e,n)},e=>{W(e,hu())}),A(s),ri(s,e=>ss?.(e)),H(`keydown`,o,e=>{e.key===`Enter`&&a(V(i)[0]),e.key===`ArrowDown`&&document.querySelector(`dialog [data-row]`)?.focus()}),ji(o,()=>V(n),e=>F(n,e)),W(e,r)},$$slots:{default:!0}}),He()}Sr([`keydown`,`click`]);var vu=U(`<li class="svelte-azvuah"><button data-row="" class="svelte-azvuah"><span aria-hidden="true"></span> <span class="mono grow cut"> </span> <span class="dim cut type svelte-azvuah"> </span> <span class="hidden"> </span></button></li>`),yu=U(`<li class="dim none svelte-azvuah"> </li>`),bu=U(`<nav aria-label="Components" class="svelte-azvuah"><div class="head svelte-azvuah"><h2>Components</h2><span class="dim number"> </span></div> <label class="hidden" for="filter">Filter components</label> <input id="filter" type="search" placeholder="Filter ( / )" autocomplete="off"/> <ul class="plain svelte-azvuah"></ul></nav>`);function xu(e,t){Ve(t,!0);let n=P(``),r=N(()=>X.status?.rows??[]),i=N(()=>Y.scene?.components.map(e=>e.name)??[...new Set(V(r).map(e=>e.component))]),a=N(()=>V(i).toSorted().filter(e=>`${e} ${o(e)?.type??``}`.toLowerCase().includes(V(n).toLowerCase()))),o=e=>Y.scene?.components.find(t=>t.name===e);function s(e){let t=o(e)?.state;if(t===`lost`)return[`bad`,`nobody sees it`];if(t===`held`)return[`accent`,`in the hand`];let n=V(r).filter(t=>t.component===e);return o(e)?.type===``?[`bad`,`not in the inventory`]:n.length?n.some(e=>e.off)?[`warn`,`not as the manifest wants it`]:[`ok`,`as the manifest wants it`]:[``,`not in the manifest`]}var c=bu(),l=I(c),u=R(z(I(l)),!0);A(l);var d=z(l,4);Ei(d);var f=z(d,2);q(f,20,()=>V(a),e=>e,(e,t)=>{let n=N(()=>{let[e,n]=s(t);return{tone:e,words:n}});var r=vu(),i=I(r),a=I(i),c=z(a,2),l=R(c,!0),u=z(c,2),d=R(u,!0),f=R(z(u,2));A(i),A(r),B((e,r)=>{J(i,`aria-pressed`,Gi.now.query.part===t),J(i,`title`,`${e??``}: ${V(n).words??``}`),fi(a,1,`dot ${V(n).tone??``}`,`svelte-azvuah`),G(l,t),G(d,r),G(f,`, ${V(n).words??``}`)},[()=>o(t)?.type.replaceAll(`_`,` `)||t,()=>o(t)?.type.replaceAll(`_`,` `)??``]),H(`click`,i,()=>Gi.go(`inspect`,{part:t})),W(e,r)},e=>{var t=yu(),r=R(t,!0);B(()=>G(r,V(i).length?`No component is called like “${V(n)}”.`:`No component is known yet.`)),W(e,t)}),A(f),ri(f,e=>ss?.(e)),A(c),B(()=>G(u,V(i).length)),ji(d,()=>V(n),e=>F(n,e)),W(e,c),He()}Sr([`click`]);var Su=U(`<option></option>`),Cu=U(`<p class="dim" role="status">Planning …</p>`),wu=U(`<span class="badge warn"> </span>`),Tu=U(`<p class="note">Nothing would move: the bench is as wanted.</p>`),Eu=U(`<button class="small"> </button>`),Du=U(`<div class="kinds svelte-r35d92" role="group" aria-label="Reasons"></div>`),Ou=U(`<progress max="1" class="svelte-r35d92"></progress>`),ku=U(`<span> </span>`),Au=U(`<li class="svelte-r35d92"><button data-row=""><span class="index number svelte-r35d92"> </span> <span class="grow svelte-r35d92"><span class="line svelte-r35d92"><b class="mono mark svelte-r35d92" aria-hidden="true"> </b> <span class="mono svelte-r35d92"> </span> <span class="svelte-r35d92"> </span></span> <span class="line svelte-r35d92"><span> </span> <span class="dim svelte-r35d92"> </span></span> <!></span> <!> <span class="dim number svelte-r35d92"> </span></button></li>`),ju=U(`<button class="small">All steps</button>`),Mu=U(`<li><span> </span> <span class="dim"> </span></li>`),Nu=U(`<details><summary class="svelte-r35d92"> </summary> <ul class="plain"></ul></details>`),Pu=U(`<span class="dim"> </span>`),Fu=U(`<!> <ol class="plain svelte-r35d92" aria-label="Operations"></ol> <div class="scrub svelte-r35d92" role="group" aria-label="Look ahead"><button class="small" aria-label="Step back">‹</button> <input type="range" min="0" step="0.1" aria-label="Scrub through the plan" class="svelte-r35d92"/> <button class="small" aria-label="Step on">›</button> <!> <span class="dim number cut svelte-r35d92" role="status"> </span></div> <!> <div class="row foot svelte-r35d92"><!> <!> <!></div>`,1),Iu=U(`<div class="sums svelte-r35d92"><strong class="number"> </strong> <span class="number"> </span> <!> <span class="badge"> </span> <!></div> <!> <!> <!>`,1),Lu=U(`<p class="dim">Nothing is planned yet. A plan moves nothing.</p>`),Ru=U(`<p class="note warn">A laser is asked to emit.</p>`),zu=U(`<li><span class="mono"> </span> </li>`),Bu=U(`<p> <strong> </strong> </p> <!> <ul class="plain changes svelte-r35d92"></ul> <!> <div class="row"><button class="main" data-first="">Apply</button><button>Leave it</button></div>`,1),Vu=U(`<form class="row"><label class="hidden" for="revision">Revision to plan for</label> <input id="revision" class="grow" list="refs" placeholder="The manifest, or a revision: e1" autocomplete="off"/> <datalist id="refs"></datalist> <button class="main" type="submit">Plan</button></form> <!> <!> <!>`,1);function Hu(e,t){Ve(t,!0);let n={changed:`changed`,in_the_way:`in the way`,staged:`staged`,stowed:`stowed`,operator:`a person`,parked:`park`,interlock:`interlock`,held:`in the hand`,align:`align`,asked:`asked for`},r=P(qt(Gi.now.query.rev??``)),i=P(!1),a=P(null),o=P(null),s=P(null),c=N(()=>[`plan`,...V(r).trim()?[V(r).trim()]:[]]),l=N(()=>X.plan),u=N(()=>V(l)!==null&&X.planned.join(` `)===V(c).join(` `)),d=N(()=>[...new Set(X.log?.commits.flatMap(e=>e.refs)??[])]),f=N(()=>[...new Set(V(l)?.operations.map(e=>e.reason.kind)??[])]),p=N(()=>V(l)?.policy.filter(e=>e.holds===!1&&e.level!==`advisory`)??[]),m=N(()=>V(l)?.diagnostics.filter(e=>e.severity===`error`)??[]),h=N(()=>X.going&&X.going.exit===null?X.going:null),g=N(()=>V(l)?.changes.some(e=>e.requested&&e.tunable!==`shutter`&&e.after)??!1),_=N(()=>V(h)?`something is under way`:V(l)?V(u)?V(m).length?`this plan can't be applied`:V(p).length?`denied by the policy of this lab`:V(l).operations.length?Y.barred:`nothing would move`:`plan anew: this plan is for something else`:`plan first`),v=N(()=>V(l)&&X.ahead?.frames.plan===V(l).digest?X.ahead:null),y=N(()=>V(v)&&V(s)?wa(V(v).frames,V(s)):V(a)),b=N(()=>V(v)&&V(y)!==null?ba(V(v).frames,Math.min(V(y),V(v).frames.seconds-.01)):[]),x=N(()=>V(b).flatMap(e=>e.robot&&V(v)&&V(y)!==null?[xa(V(v).frames,e.robot,V(y))]:[]).join(`, `)),S=e=>{V(v)&&F(a,Ca(V(v).frames,V(a)??(e>0?-1:V(v).frames.seconds),e),!0)};async function C(){Gi.set({rev:V(r).trim()||null,op:null}),F(a,null),await X.think(V(c))}async function w(){F(i,!1),F(a,null),await X.move([`apply`,...V(c).slice(1),`--yes`]),await X.think(V(c))}function T(e){let{from:t,to:n,tunable:r,measurable:i}=e.arguments;if(e.primitive===`move`){let e=n;return e?.slot?`to ${e.slot}`:`to ${So(e?.pose)}`}return e.primitive===`set`?`${r} ${So(t)} → ${So(n)}`:[e.primitive,r,i].filter(Boolean).join(` `)}_n(()=>{let e=Y.scene;return qc.ghosts=!V(l)||!e||Gi.now.tab!==`plan`?[]:V(y)===null?Xc(V(l),e,Gi.now.query.op??null):V(b).flatMap(t=>Xc(V(l),e,t.operation)),qc.outlined=e?Qc(V(m),e):[],()=>{qc.ghosts=[],qc.outlined=[]}}),_n(()=>{let e=Y.scene;return qc.phantom=V(v)&&e&&V(y)!==null?Ta(V(v),V(y),e):null,()=>qc.phantom=null});var E=Vu(),D=L(E),O=z(I(D),2);Ei(O);var ee=z(O,2);q(ee,21,()=>V(d),Gr,(e,t)=>{var n=Su(),r={};B(()=>{r!==(r=V(t))&&(n.value=(n.__value=r)??``)}),W(e,n)}),A(ee);var k=z(ee,2);A(D);var te=z(D,2);ko(te,{get words(){return V(c)}});var ne=z(te,2),re=e=>{W(e,Cu())},ie=e=>{var t=Iu(),r=L(t),c=I(r),d=R(c),g=z(c,2),C=R(g,!0),w=z(g,2),E=e=>{var t=wu(),n=R(t);B(()=>{J(t,`title`,`Parts put down in storage on the way${V(l).staging.proven?`; no plan needs fewer`:``}`),G(n,`${V(l).staging.count??``} staged`)}),W(e,t)};K(w,e=>{V(l).staging.count&&e(E)});var D=z(w,2),O=R(D,!0),ee=z(D,2),k=e=>{var t=wu(),n=R(t);B(e=>G(n,`of ${e??``}`),[()=>X.planned.slice(1).join(` `)||`the manifest`]),W(e,t)};K(ee,e=>{V(u)||e(k)}),A(r);var te=z(r,2);Ps(te,{get found(){return V(l).diagnostics}});var ne=z(te,2),re=e=>{W(e,Tu())};K(ne,e=>{!V(l).operations.length&&!V(m).length&&e(re)});var ie=z(ne,2),ae=e=>{var t=Fu(),r=L(t),c=e=>{var t=Du();q(t,21,()=>V(f),Gr,(e,t)=>{var r=Eu(),i=R(r);B(e=>{J(r,`aria-pressed`,V(o)===V(t)),G(i,`${n[V(t)]??V(t)??``} ${e??``}`)},[()=>V(l).operations.filter(e=>e.reason.kind===V(t)).length]),H(`click`,r,()=>F(o,V(o)===V(t)?null:V(t),!0)),W(e,r)}),A(t),W(e,t)};K(r,e=>{V(f).length>1&&e(c)});var u=z(r,2);q(u,23,()=>V(l).operations,e=>e.id,(e,t,r)=>{let i=N(()=>V(h)?.steps[V(t).id]??null);var a=Nr(),c=L(a),l=e=>{var a=Au(),o=I(a);let c;var l=I(o),u=R(l,!0),d=z(l,2),f=I(d),p=I(f),m=R(p,!0),h=z(p,2),g=R(h,!0),_=R(z(h,2),!0);A(f);var v=z(f,2),y=I(v);let x;var S=R(y,!0),C=R(z(y,2));A(v);var w=z(v,2),E=e=>{var n=Ou();B(()=>{Di(n,V(i).fraction),J(n,`aria-label`,`${V(t).component??``}: ${V(i).phase??``}`)}),W(e,n)};K(w,e=>{V(i)&&V(i).state===`going`&&e(E)}),A(d);var D=z(d,2),O=e=>{var n=ku();let r;var a=R(n);B((e,t)=>{r=fi(n,1,`number svelte-r35d92`,null,r,{bad:e}),G(a,`${t??``} of`)},[()=>wo(V(t),V(i).took),()=>V(i).took.toFixed(0)]),W(e,n)};K(D,e=>{V(i)?.state===`going`&&V(i).took&&e(O)});var ee=R(z(D,2),!0);A(o),A(a),B((e,a,s,l,d,f)=>{J(o,`aria-pressed`,Gi.now.query.op===V(t).id),c=fi(o,1,oi(V(i)?.state??``),`svelte-r35d92`,c,{at:e}),G(u,V(r)+1),G(m,a),G(g,V(t).component),G(_,s),x=fi(y,1,`badge svelte-r35d92`,null,x,{warn:l}),G(S,n[V(t).reason.kind]??V(t).reason.kind),G(C,`${(V(t).primitive===`set`&&V(t).reason.kind===`changed`?``:V(t).reason.text)??``}${d??``}`),G(ee,f)},[()=>V(b).some(e=>e.operation===V(t).id),()=>uo(V(t)),()=>T(V(t)),()=>[`in_the_way`,`staged`,`operator`].includes(V(t).reason.kind),()=>V(t).reason.of.length&&!V(t).reason.text?V(t).reason.of.join(`, `):``,()=>V(i)?.state===`done`?`✓ done`:V(i)?.state===`failed`?`✗ failed`:Co(V(t).seconds)]),xr(`pointerenter`,o,()=>F(s,V(t).id,!0)),xr(`pointerleave`,o,()=>F(s,null)),xr(`focus`,o,()=>F(s,V(t).id,!0)),xr(`blur`,o,()=>F(s,null)),H(`click`,o,()=>Gi.set({op:Gi.now.query.op===V(t).id?null:V(t).id,part:V(t).component})),W(e,a)};K(c,e=>{V(o)&&V(t).reason.kind!==V(o)||e(l)}),W(e,a)}),A(u),ri(u,e=>ss?.(e));var d=z(u,2),m=I(d),g=z(m,2);Ei(g);var C=z(g,2),w=z(C,2),E=e=>{var t=ju();H(`click`,t,()=>F(a,null)),W(e,t)};K(w,e=>{V(a)!==null&&e(E)});var D=R(z(w,2),!0);A(d);var O=z(d,2),ee=e=>{var t=Nu(),n=I(t),r=R(n),i=z(n,2);q(i,21,()=>V(l).policy,Gr,(e,t)=>{var n=Mu(),r=I(n),i=R(r,!0),a=z(r),o=R(z(a),!0);A(n),B(e=>{fi(r,1,oi(V(t).holds===!1?`bad`:`ok`)),G(i,V(t).holds===!1?`✗`:`✓`),G(a,` ${e??``} `),G(o,V(t).text)},[()=>V(t).rule.replaceAll(`_`,` `)]),W(e,n)}),A(i),A(t),B(()=>G(r,`Policy: ${V(p).length?`${V(p).length} denied`:`all hold`}`)),W(e,t)};K(O,e=>{V(l).policy.length&&e(ee)});var k=z(O,2),te=I(k);lo(te,{main:!0,run:()=>F(i,!0),get barred(){return V(_)},children:(e,t)=>{Ce(),W(e,Mr(`Apply …`))},$$slots:{default:!0}});var ne=z(te,2),re=e=>{lo(e,{run:()=>X.cancel(),title:`Nothing more starts; a part in the hand is set down`,children:(e,t)=>{Ce(),W(e,Mr(`Stop after this`))},$$slots:{default:!0}})};K(ne,e=>{V(h)&&e(re)});var ie=z(ne,2),ae=e=>{var t=Pu(),n=R(t,!0);B(()=>G(n,V(_))),W(e,t)};K(ie,e=>{V(_)&&e(ae)}),A(k),B((e,t)=>{m.disabled=!V(v),J(g,`max`,V(l).makespan),Di(g,V(a)??0),g.disabled=!V(v),J(g,`aria-valuetext`,e),C.disabled=!V(v),G(D,t)},[()=>V(a)===null?`the bench as it is`:`${Co(V(a))}: ${V(b).map(e=>`${e.primitive} ${e.address}`).join(`, `)} ${V(x)}`,()=>V(v)?V(y)===null?`Scrub, or move over a step: the arm shows it`:`at ${Co(V(y))}: ${V(b).map(e=>e.address).join(`, `)||`nothing moves`}${V(x)?`, ${V(x)}`:``}`:X.busy.some(e=>e.startsWith(`plan`))?`Finding the ways of the arm …`:``]),H(`click`,m,()=>S(-1)),H(`input`,g,e=>F(a,Number(e.currentTarget.value),!0)),H(`click`,C,()=>S(1)),W(e,t)};K(ie,e=>{V(l).operations.length&&e(ae)}),B(e=>{G(d,`${V(l).operations.length??``} operation${V(l).operations.length===1?``:`s`}`),G(C,e),G(O,V(l).fidelity)},[()=>Co(V(l).makespan)]),W(e,t)},ae=e=>{W(e,Lu())};K(ne,e=>{X.thinking?e(re):V(l)?e(ie,1):e(ae,-1)});var oe=z(ne,2),se=e=>{uc(e,{title:`Move the bench?`,close:()=>F(i,!1),children:(e,t)=>{var n=Bu(),r=L(n),a=I(r),o=z(a),s=R(o,!0),u=z(o);A(r);var d=z(r,2),f=e=>{W(e,Ru())};K(d,e=>{V(g)&&e(f)});var p=z(d,2);q(p,21,()=>V(l).changes,Gr,(e,t)=>{var n=zu(),r=I(n),i=R(r),a=z(r);A(n),B(()=>{G(i,`${V(t).component??``}.${V(t).tunable??``}`),G(a,` ${V(t).text??``}`)}),W(e,n)}),A(p);var m=z(p,2);{let e=N(()=>[`apply`,...V(c).slice(1),`--yes`]);ko(m,{get words(){return V(e)}})}var h=z(m,2),_=I(h),v=z(_);A(h),B(e=>{G(a,`${V(l).operations.length??``} operations, ${e??``}, to reach `),G(s,V(l).target.revision??`the manifest`),G(u,` (${V(l).backend??``}, ${V(l).fidelity??``}).`)},[()=>Co(V(l).makespan)]),H(`click`,_,w),H(`click`,v,()=>F(i,!1)),W(e,n)},$$slots:{default:!0}})};K(oe,e=>{V(i)&&V(l)&&e(se)}),B(()=>k.disabled=X.thinking),xr(`submit`,D,e=>{e.preventDefault(),C()}),ji(O,()=>V(r),e=>F(r,e)),W(e,E),He()}Sr([`click`,`input`]);function Uu(e){let{goal:t,tunable:n,measurable:r}=e.arguments;return t??(n||r?`${e.component}.${n??r}`:e.component)}function Wu(e){let{outcome:t,error:n,data:r}=e;return n?.summary?n.summary:r.measurement?Gu(r.measurement,e.numbers):r.met===void 0?r.error_mm?`${r.error_mm.toPrecision(2)} mm, ${(r.error_deg??0).toPrecision(2)}° off`:t===`done`?``:t:r.met?`met`:`not met${r.why?`: ${r.why}`:``}`}function Gu(e,t=[]){return t.length?t.map(({name:e,value:t,sigma:n,unit:r})=>`${e} ${qa(t,n)} ${r===`1`?``:r}`.trim()).join(`, `):e.unknown?`unknown: ${e.unknown}`:e.array?`an image`:String(e.value??``)}function Ku(e){return e.flatMap(({data:e})=>[e.measurement?.array,...(e.stages??[]).map(e=>e.points),e.points].filter(e=>e!=null))}function qu({rows:e},t){return e.map(e=>e.values[t]??null)}function Ju(e){return[...new Set(e.tunables.map(e=>e.unit))].flatMap(t=>{let n=e.tunables.filter(e=>e.unit===t);return Array.from({length:Math.ceil(n.length/4)},(r,i)=>{let a=n.slice(4*i,4*i+4);return{name:a.length===1?a[0].name:`tunables`,unit:t,series:a.map(({name:t})=>({name:t,values:qu(e,t)}))}})})}function Yu(e){let t=(e.seconds??0)-(e.planned??e.seconds??0);return Math.abs(t)<.05?``:`${t>0?`+`:`−`}${Math.abs(t).toFixed(1)} s`}function Xu(e,t,n){let r=t.toLowerCase().split(/\s+/).filter(Boolean);return e.filter(e=>{let t=[e.id,e.number,e.cause.kind,e.goal,e.operator,e.outcome,...e.changes.map(e=>`${e.component}.${e.tunable}`)].join(` `).toLowerCase();return(!n||e.evidence===n)&&r.every(e=>t.includes(e))})}var Zu=U(`<tr><td class="svelte-1q4eogf"> </td><td class="svelte-1q4eogf"> </td><td class="svelte-1q4eogf"> </td></tr>`),Qu=U(`<h3>Otherwise</h3> <table><thead><tr><th class="svelte-1q4eogf"></th><th class="svelte-1q4eogf"> </th><th class="svelte-1q4eogf"> </th></tr></thead><tbody></tbody></table>`,1),$u=U(`<li><span class="mono"> </span> </li>`),ed=U(`<h3> </h3> <ul class="plain"></ul>`,1),td=U(`<tr><td class="mono svelte-1q4eogf"> </td><td class="number svelte-1q4eogf"> </td><td class="number svelte-1q4eogf"> </td><td class="dim svelte-1q4eogf"> </td></tr>`),nd=U(`<h3>Measured in both</h3> <table><tbody></tbody></table>`,1),rd=U(`<p> </p> <!> <!> <!>`,1),id=U(`<p class="dim" role="status">Comparing …</p>`),ad=U(`<section aria-label="Two runs" class="svelte-1q4eogf"><div class="row"><h2 class="grow"> </h2><button class="small bare" aria-label="Close">✕</button></div> <!> <!></section>`);function od(e,t){Ve(t,!0);let n=N(()=>[`runs`,`compare`,t.a,t.b]),r=P(null);_n(()=>{let e=V(n);F(r,null),fr(()=>X.read(`pico.run-comparison/v1`,...e)).then(t=>{e===V(n)&&F(r,t)})});let i=e=>e&&typeof e==`object`?JSON.stringify(e):String(e??`–`).replace(/^sha256:(.{12}).*/,`$1`);var a=ad(),o=I(a),s=I(o),c=R(s,!0),l=z(s);A(o);var u=z(o,2);ko(u,{get words(){return V(n)}});var d=z(u,2),f=e=>{var t=rd(),n=L(t),a=R(n),o=z(n,2),s=e=>{var t=Qu(),n=z(L(t),2),a=I(n),o=I(a),s=z(I(o)),c=R(s,!0),l=R(z(s),!0);A(o),A(a);var u=z(a);q(u,21,()=>V(r).differing,Gr,(e,t)=>{var n=Zu(),r=I(n),a=R(r,!0),o=z(r),s=R(o,!0),c=R(z(o),!0);A(n),B((e,n)=>{G(a,V(t).name),G(s,e),G(c,n)},[()=>i(V(t).a),()=>i(V(t).b)]),W(e,n)}),A(u),A(n),B(()=>{G(c,V(r).a.number),G(l,V(r).b.number)}),W(e,t)};K(o,e=>{V(r).differing.length&&e(s)});var c=z(o,2),l=e=>{var t=ed(),n=L(t),i=R(n),a=z(n,2);q(a,21,()=>V(r).changes,Gr,(e,t)=>{var n=$u(),r=I(n),i=R(r),a=z(r);A(n),B(()=>{G(i,`${V(t).component??``}.${V(t).tunable??``}`),G(a,` ${V(t).text??``}`)}),W(e,n)}),A(a),B(()=>G(i,`From where ${V(r).a.number??``} ended to where ${V(r).b.number??``} did`)),W(e,t)};K(c,e=>{V(r).changes?.length&&e(l)});var u=z(c,2),d=e=>{var t=nd(),n=z(L(t),2),i=I(n);q(i,21,()=>V(r).measured,Gr,(e,t)=>{var n=td(),r=I(n),i=R(r,!0),a=z(r),o=R(a,!0),s=z(a),c=R(s,!0),l=R(z(s),!0);A(n),B((e,n,r)=>{G(i,V(t).address),G(o,e),G(c,n),G(l,r)},[()=>Gu(V(t).a,V(t).numbers.a),()=>Gu(V(t).b,V(t).numbers.b),()=>V(t).incomparable?.join(`, `)??``]),W(e,n)}),A(i),A(n),W(e,t)};K(u,e=>{V(r).measured.length&&e(d)}),B((e,t)=>G(a,`${V(r).same?`Both led to the same state.`:`They led to different states.`} ${e??``} against ${t??``}.`),[()=>Co(V(r).a.seconds),()=>Co(V(r).b.seconds)]),W(e,t)},p=e=>{W(e,id())};K(d,e=>{V(r)?e(f):e(p,-1)}),A(a),B(()=>G(c,V(r)?`Run ${V(r).a.number} and run ${V(r).b.number}`:`Two runs`)),H(`click`,l,function(...e){t.close?.apply(this,e)}),W(e,a),He()}Sr([`click`]);var sd=U(`<section class="svelte-gb5koi"><h4 class="row wrap svelte-gb5koi"><span class="mono grow"> </span> <span> </span></h4> <p class="dim"> </p> <!> <details class="svelte-gb5koi"><summary class="svelte-gb5koi">What was read, and how tunables went</summary> <!> <!></details></section>`);function cd(e,t){Ve(t,!0);let n=N(()=>t.search.rows.map((e,t)=>t+1)),r=N(()=>t.search.rows.filter(e=>e.merit===null).length),i=N(()=>t.search.rows.length>1?t.search.rows.at(-1).values.time-t.search.rows[0].values.time:0),a=`measurement`;var o=sd(),s=I(o),c=I(s),l=R(c,!0),u=z(c,2),d=R(u,!0);A(s);var f=z(s,2),p=R(f),m=z(f,2);{let e=N(()=>t.search.aim===`reach`),r=N(()=>t.search.aim===`reach`?`How far from the goal, in tolerances`:`${t.search.aim}: ${t.search.merit}`),i=N(()=>t.search.enough===null?void 0:[0,t.search.enough]),o=N(()=>[{name:`measured`,values:t.search.rows.map(e=>e.merit),sigmas:t.search.rows.map(e=>e.sigma),dots:!0},{name:`best so far`,values:t.search.rows.map(e=>e.best)}]);Uo(m,{caption:!0,whole:!0,height:170,get log(){return V(e)},get title(){return V(r)},across:a,get level(){return V(i)},get x(){return V(n)},get series(){return V(o)}})}var h=z(m,2),g=z(I(h),2),_=e=>{var r=Nr();q(L(r),17,()=>t.search.outputs,Gr,(e,r)=>{{let i=N(()=>jo(V(r))),o=N(()=>V(r).target===null?void 0:[V(r).target-(V(r).tolerance??0),V(r).target+(V(r).tolerance??0)]),s=N(()=>[{name:V(r).name,values:qu(t.search,V(r).name),sigmas:qu(t.search,`${V(r).name}_sigma`),dots:!0}]);Uo(e,{whole:!0,get title(){return V(r).name},across:a,get up(){return V(i)},get x(){return V(n)},get level(){return V(o)},get series(){return V(s)}})}}),W(e,r)};K(g,e=>{t.search.aim===`reach`&&e(_)}),q(z(g,2),17,()=>Ju(t.search),Gr,(e,t)=>{{let r=N(()=>V(t).series.map(({name:e})=>e).join(`, `)),i=N(()=>jo(V(t)));Uo(e,{whole:!0,get title(){return V(r)},across:a,get up(){return V(i)},get x(){return V(n)},get series(){return V(t).series}})}}),A(h),A(o),B((e,n)=>{J(o,`aria-label`,`Search for ${t.search.goal??``}`),G(l,t.search.goal),fi(u,1,`badge ${t.search.met?`ok`:`warn`}`),G(d,t.search.met?`met`:`not met`),G(p,`By ${e??``}: ${t.search.why??``}; ${t.search.rows.length??``} measured in ${n??``}${V(r)?`, ${V(r)} of them in the dark`:``}.`)},[()=>t.search.algorithm.replaceAll(`_`,` `),()=>Co(V(i))]),W(e,o),He()}var ld=U(`<li><button class="svelte-im0evi"><!> <span class="cut"> </span></button></li>`),ud=U(`<ul class="plain shots svelte-im0evi"></ul>`),dd=U(`<p class="dim" role="status"> </p>`),fd=U(`<div class="row"><button> </button></div>`),pd=U(`<span> </span>`),md=U(`<div><dt class="dim svelte-im0evi"> </dt><dd class="svelte-im0evi"><!></dd></div>`),hd=U(`<!> <dl class="number svelte-im0evi"></dl> <p class="dim small svelte-im0evi"> </p> <div class="row"><button data-first="">Close</button></div> <!>`,1),gd=U(`<section aria-label="Pictures and searches" class="svelte-im0evi"><h3>Pictures and searches</h3> <!> <!> <!> <!> <!> <!></section> <!>`,1);function _d(e,t){Ve(t,!0);let n=N(()=>Ku(t.operations)),r=P([]),i=P(0),a=P(!1),o=P([]),s=P(null),c=P(null),l=N(()=>V(r).filter(e=>e.schema===`pico.still/v1`)),u=N(()=>V(r).filter(e=>e.schema===`pico.curve/v1`)),d=N(()=>V(r).filter(e=>e.schema===`pico.search/v1`)),f=(e,n)=>[`runs`,`pictures`,t.run,...e.flatMap(e=>[`--of`,e]),`--width`,n];Bi(()=>void p());async function p(){let e=V(n).slice(V(i),V(i)+12);F(a,!0);let t=await X.run(f(e.map(e=>e.sha256),`160`));F(r,[...V(r),...t.said.filter(e=>`operation`in e)]),F(o,[...V(o),...t.diagnostics]),F(i,V(i)+e.length),F(a,!1)}async function h({sha256:e}){F(c,e,!0);let t=await X.run(f([e],`1280`));F(s,t.said.find(e=>`schema`in e&&e.schema===`pico.still/v1`)??null),F(c,null),V(s)||F(o,t.diagnostics)}function g(e){let{exposure:t,gain:n}=e.settings;return[t===void 0?``:`exposure ${String(t)} ms`,n===void 0?``:`gain ${String(n)}${typeof n==`number`?` dB`:``}`].filter(Boolean).join(`, `)}let _=e=>`${e.component}.${e.measurable}, ${e.operation}`;var v=gd(),y=L(v),b=z(I(y),2),x=e=>{var t=ud();q(t,21,()=>V(l),Gr,(e,t)=>{var n=ld(),r=I(n),i=I(r);{let e=N(()=>({...V(t),marks:[]}));$a(i,{get still(){return V(e)},alt:``})}var a=R(z(i,2));A(r),A(n),B((e,n,i)=>{r.disabled=V(c)!==null,J(r,`aria-label`,`${e??``}: larger`),J(r,`title`,`${n??``}, ${i??``}`),G(a,`${(V(c)===V(t).sha256?`reading …`:V(t).operation)??``}${V(t).saturated?` · saturated`:``}`)},[()=>_(V(t)),()=>_(V(t)),()=>g(V(t))]),H(`click`,r,()=>h(V(t))),W(e,n)}),A(t),W(e,t)};K(b,e=>{V(l).length&&e(x)});var S=z(b,2);q(S,17,()=>V(u),Gr,(e,t)=>{{let n=N(()=>jo(V(t).x)),r=N(()=>jo(V(t).y)),i=N(()=>V(t).points.map(e=>e.x)),a=N(()=>[{name:V(t).y.name,values:V(t).points.map(e=>e.y)}]);Uo(e,{caption:!0,get title(){return`${V(t).component??``}.${V(t).measurable??``}, ${V(t).operation??``}`},get across(){return V(n)},get up(){return V(r)},get x(){return V(i)},get series(){return V(a)}})}});var C=z(S,2);q(C,17,()=>V(d),Gr,(e,t)=>{cd(e,{get search(){return V(t)}})});var w=z(C,2),T=e=>{var t=dd(),r=R(t);B(e=>G(r,`Reading ${e??``} …`),[()=>V(n).length===1?`what it kept`:`${Math.min(12,V(n).length-V(i))} of ${V(n).length}`]),W(e,t)},E=e=>{var t=fd(),r=I(t),a=R(r);A(t),B(e=>G(a,`Show ${e??``} more of ${V(n).length-V(i)}`),[()=>Math.min(12,V(n).length-V(i))]),H(`click`,r,p),W(e,t)};K(w,e=>{V(a)?e(T):V(i)<V(n).length&&e(E,1)});var D=z(w,2);Ps(D,{get found(){return V(o)}});var O=z(D,2);{let e=N(()=>[`runs`,`pictures`,t.run]);ko(O,{get words(){return V(e)}})}A(y);var ee=z(y,2),k=e=>{let n=N(()=>V(s));{let r=N(()=>_(V(n)));uc(e,{get title(){return V(r)},wide:!0,close:()=>F(s,null),children:(e,r)=>{var i=hd(),a=L(i);$a(a,{get still(){return V(n)},get alt(){return`What ${V(n).component??``} saw`}});var o=z(a,2);q(o,21,()=>Object.entries(V(n).values),Gr,(e,t)=>{var n=N(()=>m(V(t),2));let r=()=>V(n)[0],i=()=>V(n)[1];var a=md(),o=I(a),s=R(o,!0),c=z(o),l=I(c),u=e=>{var t=Mr();B(()=>G(t,i().unknown)),W(e,t)},d=e=>{var t=Nr();q(L(t),17,()=>Ka(i()),Gr,(e,t)=>{var n=pd(),r=R(n);B(e=>G(r,`${V(t).name??``} ${e??``} ${(V(t).unit===`1`?``:V(t).unit)??``}`),[()=>qa(V(t).value,V(t).sigma)]),W(e,n)}),W(e,t)};K(l,e=>{i().unknown?e(u):e(d,-1)}),A(c),A(a),B(()=>G(s,r())),W(e,a)}),A(o);var c=z(o,2),l=R(c),u=z(c,2),d=R(u),f=z(u,2);{let e=N(()=>[`runs`,`pictures`,t.run,`--of`,V(n).operation]);ko(f,{get words(){return V(e)}})}B(e=>G(l,`${e??``}; ${V(n).by===1?`each pixel of the camera is one here`:`${V(n).by} x ${V(n).by} pixels of the camera are one here`}, the brightest is white${V(n).saturated?`; saturated: ${V(n).saturated}`:``}.`),[()=>g(V(n))]),H(`click`,d,()=>F(s,null)),W(e,i)},$$slots:{default:!0}})}};K(ee,e=>{V(s)&&e(k)}),W(e,v),He()}Sr([`click`]);var vd=U(`<button class="main">Back to live</button>`),yd=U(`<button class="main">Replay in the twin</button>`),bd=U(`<!> <!>`,1),xd=U(`<li><button class="small bare mono"> </button> </li>`),Sd=U(`<details><summary class="svelte-mr3qs1"> </summary> <ul class="plain"></ul></details>`),Cd=U(`<span class="late svelte-mr3qs1"> </span>`),wd=U(`<li class="svelte-mr3qs1"><button data-row=""><span class="number dim when svelte-mr3qs1"> </span> <span class="grow svelte-mr3qs1"><span class="mono"> </span> <span class="dim"> </span></span> <span class="number took svelte-mr3qs1"> <!></span></button></li>`),Td=U(`<!><!>`,1),Ed=U(`<tr><td class="mono svelte-mr3qs1"> </td><td class="number svelte-mr3qs1"> </td></tr>`),Dd=U(`<p class="dim"> </p>`),Od=U(`<h3>Measured</h3> <!> <table><tbody></tbody></table> <!>`,1),kd=U(`<li><span class="mono"> </span> <span class="dim"> </span></li>`),Ad=U(`<h3>Steps</h3> <ol class="plain steps svelte-mr3qs1" aria-label="Steps of the run"></ol> <!> <!> <!>`,1),jd=U(`<p class="dim" role="status">Reading the run …</p>`),Md=U(`<section class="svelte-mr3qs1"><h2> </h2> <p class="dim"> <span class="badge" title="A simulation never counts as hardware evidence"> </span> </p> <div class="row wrap svelte-mr3qs1"><!> <!></div> <!> <!> <p> </p> <!> <!> <!></section>`);function Nd(e,t){Ve(t,!0);let n=P(null),r=P(null),i=N(()=>V(n)?.operations.filter(e=>e.data.measurement)??[]),a=N(()=>V(r)&&Po(V(r).points)),o=N(()=>t.run.changes.filter(e=>!e.tolerated)),s=N(()=>[`failed`,`interrupted`,`killed`].includes(t.run.outcome)&&X.runs[0]?.id===t.run.id),c=N(()=>Ua.frames?.run===t.run.id),l=N(()=>X.going&&X.going.exit===null?`something is under way`:Y.barred);Bi(async()=>{if(F(n,await X.read(`pico.recorded/v1`,`runs`,`show`,t.run.id)),(V(n)?.operations.filter(e=>e.data.measurement).length??0)<2)return;let e=await X.run([`runs`,`plot`,t.run.id]);F(r,e.said.find(e=>`schema`in e&&e.schema===`pico.plotted/v1`)??null)});function u(e){return(V(c)?Ua.frames.steps.find(t=>t.operation===e.id&&t.attempt===e.attempt&&(t.run??``)===e.run):null)?.start??e.start??0}let d=N(()=>V(c)?Ua.time:null),f=e=>V(d)!==null&&e.start!=null&&u(e)<=V(d)&&V(d)<u(e)+Math.max(e.seconds??0,.05);function p(e){V(c)?(Ua.playing=!1,Ua.seek(e)):Gi.set({run:t.run.id,t:e.toFixed(2)})}var m=Md(),h=I(m),g=R(h),_=z(h,2),v=I(_),y=z(v),b=R(y,!0),x=z(y);A(_);var S=z(_,2),C=I(S),w=e=>{var t=vd();H(`click`,t,()=>Ua.close()),W(e,t)},T=e=>{var t=yd();B(()=>t.disabled=Ua.opening!==null),H(`click`,t,()=>p(0)),W(e,t)};K(C,e=>{V(c)?e(w):e(T,-1)});var E=z(C,2),D=e=>{var t=bd(),n=L(t);lo(n,{get barred(){return V(l)},run:()=>X.move([`resume`,`--yes`]),title:`Looks, plans from there, repeats nothing`,children:(e,t)=>{Ce(),W(e,Mr(`Resume`))},$$slots:{default:!0}}),lo(z(n,2),{get barred(){return V(l)},run:()=>X.move([`recover`,`--yes`]),title:`Sets down what hands still hold`,children:(e,t)=>{Ce(),W(e,Mr(`Recover`))},$$slots:{default:!0}}),W(e,t)};K(E,e=>{V(s)&&e(D)}),A(S);var O=z(S,2);{let e=N(()=>[`runs`,`show`,t.run.id]);ko(O,{get words(){return V(e)}})}var ee=z(O,2),k=e=>{ko(e,{words:[`resume`]})};K(ee,e=>{V(s)&&e(k)});var te=z(ee,2),ne=R(te,!0),re=z(te,2),ie=e=>{Ps(e,{get found(){return V(n).diagnostics}})};K(re,e=>{V(n)&&e(ie)});var ae=z(re,2),oe=e=>{var t=Sd(),n=I(t),r=R(n),i=z(n,2);q(i,21,()=>V(o),Gr,(e,t)=>{var n=xd(),r=I(n),i=R(r),a=z(r);A(n),B(()=>{G(i,`${V(t).component??``}.${V(t).tunable??``}`),G(a,` ${V(t).text??``}`)}),H(`click`,r,()=>Gi.go(`inspect`,{part:V(t).component})),W(e,n)}),A(i),A(t),B(()=>{t.open=V(o).length<5,G(r,`Changed ${V(o).length??``}`)}),W(e,t)};K(ae,e=>{V(o).length&&e(oe)});var se=z(ae,2),ce=e=>{var o=Ad(),s=z(L(o),2);q(s,21,()=>V(n).operations,e=>`${e.run}/${e.id}/${e.attempt}`,(e,t)=>{var n=wd(),r=I(n);let i;var a=I(r),o=R(a,!0),s=z(a,2),c=I(s),l=R(c,!0),d=z(c),m=R(z(d),!0);A(s);var h=z(s,2),g=I(h),_=z(g),v=e=>{var n=Cd(),r=R(n,!0);B((e,t)=>{J(n,`title`,`Planned: ${e??``}`),G(r,t)},[()=>Co(V(t).planned??0),()=>Yu(V(t))]),W(e,n)},y=N(()=>Yu(V(t)));K(_,e=>{V(y)&&e(v)}),A(h),A(r),A(n),B((e,n,a,s,c)=>{J(r,`aria-current`,e),r.disabled=V(t).start==null,J(r,`title`,V(t).start==null?`It did not begin`:`See it in the replay`),i=fi(r,1,`svelte-mr3qs1`,null,i,{bad:V(t).outcome===`failed`||V(t).outcome===`unknown`}),G(o,n),G(l,a),G(d,` ${V(t).primitive??``}${V(t).attempt>1?`, attempt ${V(t).attempt}`:``} `),G(m,s),G(g,`${c??``} `)},[()=>f(V(t))?`step`:void 0,()=>V(t).start==null?`–`:`${u(V(t)).toFixed(1)} s`,()=>Uu(V(t)),()=>Wu(V(t)),()=>V(t).seconds==null?``:Co(V(t).seconds)]),H(`click`,r,()=>p(u(V(t)))),W(e,n)}),A(s),ri(s,e=>ss?.(e));var c=z(s,2),l=e=>{var n=Od(),o=z(L(n),2),s=e=>{var n=Td(),i=L(n);{let e=N(()=>jo(V(r).x)),t=N(()=>jo(V(r).y)),n=N(()=>V(a).map(e=>e.x)),o=N(()=>[{name:V(r).y.name,values:V(a).map(e=>e.y),sigmas:V(a).map(e=>e.sigma),dots:!0}]);Uo(i,{caption:!0,height:190,get title(){return V(r).title},get across(){return V(e)},get up(){return V(t)},get x(){return V(n)},get series(){return V(o)}})}var o=z(i);{let e=N(()=>[`runs`,`plot`,t.run.id]);ko(o,{get words(){return V(e)}})}W(e,n)};K(o,e=>{V(r)&&V(a)&&e(s)});var c=z(o,2),l=I(c);q(l,21,()=>V(i).slice(0,40),Gr,(e,t)=>{var n=Ed(),r=I(n),i=R(r,!0),a=R(z(r),!0);A(n),B((e,t)=>{G(i,e),G(a,t)},[()=>Uu(V(t)),()=>Gu(V(t).data.measurement,V(t).numbers)]),W(e,n)}),A(l),A(c);var u=z(c,2),d=e=>{var t=Dd(),n=R(t);B(()=>G(n,`and ${V(i).length-40} more`)),W(e,t)};K(u,e=>{V(i).length>40&&e(d)}),W(e,n)};K(c,e=>{V(i).length&&e(l)});var d=z(c,2),m=e=>{_d(e,{get run(){return t.run.id},get operations(){return V(n).operations}})},h=N(()=>Ku(V(n).operations).length);K(d,e=>{V(h)&&e(m)});var g=z(d,2),_=e=>{var t=Sd(),r=I(t),i=R(r),a=z(r,2);q(a,21,()=>V(n).artifacts,Gr,(e,t)=>{var n=kd(),r=I(n),i=R(r,!0),a=R(z(r,2));A(n),B(e=>{G(i,V(t).artifact.name),G(a,`${e??``} kB${V(t).present?``:`, not here: pico data pull`}`)},[()=>(V(t).artifact.size/1e3).toFixed(0)]),W(e,n)}),A(a),A(t),B(()=>G(i,`Data beside it: ${V(n).artifacts.length??``}`)),W(e,t)};K(g,e=>{V(n).artifacts.length&&e(_)}),W(e,o)},le=e=>{W(e,jd())};K(se,e=>{V(n)?e(ce):e(le,-1)}),A(m),B((e,n,r,i,a)=>{J(m,`aria-label`,`Run ${t.run.number??``}`),G(g,`Run ${t.run.number??``}: ${e??``}`),G(v,`${t.run.operator??``}, ${n??``}, ${r??``} · `),G(b,t.run.evidence),G(x,` ${i??``}`),G(ne,a)},[()=>Eo(t.run),()=>To(t.run.started_at),()=>Co(t.run.seconds),()=>V(n)?.commit?`· carried by ${V(n).commit.slice(0,7)}`:V(n)?`· no commit has it yet`:``,()=>Object.entries(t.run.tally).filter(([,e])=>e).map(([e,t])=>`${t} ${e}`).join(`, `)]),W(e,m),He()}Sr([`click`]);var Pd=U(`<option> </option>`),Fd=U(`<span class="badge" title="No commit here has it, and none of yours takes it"> </span>`),Id=U(`<li class="svelte-14ipwnh"><button data-row="" class="svelte-14ipwnh"><span class="number index svelte-14ipwnh"> </span> <span class="grow what svelte-14ipwnh"> </span> <span class="about svelte-14ipwnh"><span class="badge" title="What it proves: a simulation never counts as hardware evidence"> </span> <!> <span> </span> <span class="dim number"> </span></span></button></li>`),Ld=U(`<li class="dim none svelte-14ipwnh"> </li>`),Rd=U(`<label class="row">Compare with <select class="grow svelte-14ipwnh"><option>another run …</option><!></select></label>`),zd=U(`<!> <!>`,1),Bd=U(`<div class="row"><label class="hidden" for="runs-filter">Find a run</label> <input id="runs-filter" class="grow svelte-14ipwnh" placeholder="Find: apply, e1, p2.angle, failed" autocomplete="off"/> <label class="hidden" for="runs-evidence">Evidence</label> <select id="runs-evidence" class="svelte-14ipwnh"><option>All evidence</option><!></select></div> <ol class="plain svelte-14ipwnh" aria-label="Runs"></ol> <!>`,1);function Vd(e,t){Ve(t,!0);let n=P(``),r=P(``),i=P(null),a=N(()=>[...X.runs,...X.others].sort((e,t)=>t.started_at.localeCompare(e.started_at))),o=N(()=>new Set(X.others.map(e=>e.id))),s=N(()=>V(a).find(e=>e.id===Gi.now.query.run)??null),c=N(()=>[...new Set(V(a).map(e=>e.evidence))]),l=N(()=>Xu(V(a),V(n),V(r))),u=e=>e===`done`?`ok`:e===``?`accent`:`bad`;function d(e,t){V(s)&&V(s).id!==t&&(e.ctrlKey||e.metaKey)?F(i,V(i)===t?null:t,!0):(F(i,null),Gi.set({run:V(s)?.id===t?null:t,t:null}))}var f=Bd(),p=L(f),m=z(I(p),2);Ei(m);var h=z(m,4),g=I(h);g.value=g.__value=``,q(z(g),17,()=>V(c),Gr,(e,t)=>{var n=Pd(),r=R(n,!0),i={};B(()=>{G(r,V(t)),i!==(i=V(t))&&(n.__value=i)}),W(e,n)}),A(h),vi(h),A(p);var _=z(p,2);q(_,21,()=>V(l),e=>e.id,(e,t)=>{var n=Id(),r=I(n),a=I(r),c=R(a,!0),l=z(a,2),f=R(l,!0),p=z(l,2),m=I(p),h=R(m,!0),g=z(m,2),_=e=>{var n=Fd(),r=R(n);B(()=>G(r,`${(V(t).operator||`somebody`)??``}'s, not in your history`)),W(e,n)},v=N(()=>V(o).has(V(t).id));K(g,e=>{V(v)&&e(_)});var y=z(g,2),b=R(y,!0),x=R(z(y,2),!0);A(p),A(r),A(n),B((e,n,a)=>{J(r,`aria-pressed`,V(s)===V(t)||V(i)===V(t).id),G(c,V(t).number),G(f,e),G(h,V(t).evidence),fi(y,1,`badge ${n??``}`,`svelte-14ipwnh`),G(b,V(t).outcome||`going`),G(x,a)},[()=>Eo(V(t)),()=>u(V(t).outcome),()=>To(V(t).started_at)]),H(`click`,r,e=>d(e,V(t).id)),W(e,n)},e=>{var t=Ld(),n=R(t,!0);B(()=>G(n,V(a).length?`No run is so.`:`Nothing has run on this bench yet.`)),W(e,t)}),A(_),ri(_,e=>ss?.(e));var v=z(_,2),y=e=>{od(e,{get a(){return V(s).id},get b(){return V(i)},close:()=>F(i,null)})},b=e=>{var t=zd(),n=L(t);Wr(n,()=>V(s).id,e=>{Nd(e,{get run(){return V(s)}})});var r=z(n,2),o=e=>{var t=Rd(),n=z(I(t)),r=I(n);r.value=r.__value=``,q(z(r),17,()=>V(a).filter(e=>e.id!==V(s).id),Gr,(e,t)=>{var n=Pd(),r=R(n),i={};B((e,a)=>{G(r,`${V(t).number??``}: ${e??``}, ${a??``}`),i!==(i=V(t).id)&&(n.value=(n.__value=i)??``)},[()=>Eo(V(t)),()=>To(V(t).started_at)]),W(e,n)}),A(n),n.value=n.__value=``,A(t),H(`change`,n,e=>F(i,e.currentTarget.value||null,!0)),W(e,t)};K(r,e=>{V(a).length>1&&e(o)}),W(e,t)},x=e=>{ko(e,{words:[`runs`]})};K(v,e=>{V(s)&&V(i)?e(y):V(s)?e(b,1):e(x,-1)}),ji(m,()=>V(n),e=>F(n,e)),yi(h,()=>V(r),e=>F(r,e)),W(e,f),He()}Sr([`click`,`change`]);var Hd=e=>typeof e.desired==`object`&&e.desired!==null&&!(`x`in e.desired),Ud=(e,t,n=`${t}s`)=>`${e} ${e===1?t:n}`,Wd=e=>e.tunable===`pose`?e.component:`${e.component}.${e.tunable}`;function Gd(e){let t=[...new Set(e.map(Wd))];return t.length>3?`${t.slice(0,3).join(`, `)} and ${t.length-3} more`:t.join(`, `)}function Kd(e,t){return t?.guard??(e?.cut_short??[]).filter(e=>e.code===`guard`)}function qd(e){return(e?.cut_short??[]).filter(e=>e.severity!==`note`&&![`guard`,`goes-on`].includes(e.code))}function Jd({status:e,scene:t,runs:n,line:r,edge:i,busy:a,asks:o}){let s=e?.rows??[],c=[];r===`lost`?c.push({tone:`bad`,text:`The line to the coordinator is lost`,mend:`it is tried again by itself`,to:null}):i===`away`&&c.push({tone:`bad`,text:`The bench's edge is not connected`,mend:"start `pico edge` beside the table",to:null}),o&&c.push({tone:`warn`,text:`A recipe waits for an answer: ${o}`,mend:`answer it`,to:{tab:`do`,query:{act:`recipes`}}});let l=Kd(e,t),u=qd(e);for(let e of l)c.push({tone:`bad`,text:e.summary,detail:e.detail,mend:e.hint||`make the table safe`,to:null});for(let e of u)c.push(e.code===`cut-short`?{tone:`bad`,text:e.summary,detail:e.hint,mend:`look at the run`,to:{tab:`runs`,query:n[0]?{run:n[0].id}:{}}}:{tone:`bad`,text:e.summary,detail:e.detail,mend:e.hint||"see `pico status`",to:null});for(let t of e?.lacking??[])c.push({tone:`warn`,text:t.summary,detail:t.detail,mend:t.hint||"see `pico devices check`",to:null});for(let e of t?.components??[]){let t={tab:`inspect`,query:{part:e.name}};e.state===`lost`?c.push({tone:`bad`,text:`${e.name}: nobody sees it`,mend:`look where it is`,to:t}):e.type===``&&e.position?c.push({tone:`bad`,text:`${e.name} stands on the table and is not in the inventory`,mend:`look what it is`,to:t}):e.state===`held`&&!a&&c.push({tone:`bad`,text:`${e.held_by??`A hand`} holds ${e.name}, and nothing goes on`,mend:`look at the run: Recover sets it down`,to:{tab:`runs`,query:n[0]?{run:n[0].id}:{}}})}let d=n[0];d&&![``,`done`].includes(d.outcome)&&!u.some(e=>e.code===`cut-short`)&&c.push({tone:`bad`,text:`Run ${d.number} (${Eo(d)}) ended: ${d.outcome}`,mend:`look at the run`,to:{tab:`runs`,query:{run:d.id}}});let f=s.filter(e=>e.off&&!e.note),p=[[f.filter(Hd),e=>`${Ud(e.length,`goal`)} found by light ${e.length===1?`is`:`are`} not reached any more`],[f.filter(e=>e.drifted&&!Hd(e)),e=>`${Ud(e.length,`value`)} neither as committed nor as wanted`],[f.filter(e=>!e.drifted&&!Hd(e)),e=>`${Ud(e.length,`value`)} of the manifest not on the bench yet`]];for(let[e,t]of p)e.length&&c.push({tone:`warn`,text:`${t(e)}: ${Gd(e)}`,mend:`plan what brings it there`,to:{tab:`plan`,query:{rev:``}}});let m=s.filter(e=>e.edited);return m.length&&c.push({tone:`warn`,text:`${Ud(m.length,`edit`)} in no commit: ${Gd(m)}`,mend:`look at it, and commit`,to:{tab:`inspect`,query:{part:m[0].component}}}),c}var Yd=U(`<span> </span>`),Xd=U(` <span class="wide svelte-c5xi31">&nbsp;to look at</span><span class="narrow svelte-c5xi31">&nbsp;!</span>`,1),Zd=U(`<span class="wide svelte-c5xi31">all well</span><span class="narrow svelte-c5xi31">✓</span>`,1),Qd=U(`<p class="dim"> </p>`),$d=U(`<button class="small"> </button>`),ef=U(`<p> </p>`),tf=U(`<li><p> </p><!> <!></li>`),nf=U(`<li class="dim">Nothing: the bench is as the manifest wants it, and all of it is committed.</li>`),rf=U(` <strong> </strong>`,1),af=U(`<p class="dim"> </p> <div class="row"><!></div>`,1),of=U(`<li class="note svelte-c5xi31"><p><span class="mono"> </span><!></p> <!></li>`),sf=U(`<h3>Lasers and shutters</h3> <ul class="plain svelte-c5xi31"></ul> <!>`,1),cf=U(`<ul class="plain svelte-c5xi31"></ul> <!>`,1),lf=U(`<button class="chip svelte-c5xi31" title="What needs attention, and what lets lasers emit"><!> <span><!></span></button> <!>`,1);function uf(e,t){Ve(t,!0);let n=P(!1),r=N(()=>Jd({status:X.status,scene:Y.scene,runs:X.runs,line:Y.line,edge:Y.edge,busy:!!Y.lease?.holder,asks:X.question?.text??null})),i=N(()=>V(r).some(e=>e.tone===`bad`)?`bad`:V(r).length?`warn`:`ok`),a=N(()=>Y.scene?.beams.some(e=>e.lit)??!1),o=N(()=>Y.scene?.components.filter(e=>e.tunables.emission||e.tunables.shutter)??[]),s=N(()=>aa.may(`operator`,Y.lab)?null:`needs the role operator`);function c(e){F(n,!1),e.to&&Gi.go(e.to.tab,e.to.query),e.to?.tab===`plan`&&X.think([`plan`])}function l(e){return e.broken?`its arming can't be read, and does not count: ${e.broken}`:e.arming?`armed by ${e.arming.by} until ${new Date(e.arming.ends).toLocaleTimeString(void 0,{hour:`2-digit`,minute:`2-digit`})}`:{low:`class 1 or 2: nobody has to arm it`,waived:`the lab waives arming`,nothing:`not armed`}[e.lets]??e.lets}var u=lf(),d=L(u),f=I(d),p=e=>{var t=Yd(),n=R(t,!0);B(()=>{fi(t,1,`badge ${V(a)?`warn`:``}`),G(n,V(a)?`☀ light`:`dark`)}),W(e,t)};K(f,e=>{V(o).length&&e(p)});var m=z(f,2),h=I(m),g=e=>{var t=Xd(),n=L(t,!0);Ce(2),B(()=>G(n,V(r).length)),W(e,t)},_=e=>{var t=Zd();Ce(),W(e,t)};K(h,e=>{V(r).length?e(g):e(_,-1)}),A(m),A(d);var v=z(d,2),y=e=>{uc(e,{title:`What needs attention`,close:()=>F(n,!1),children:(e,t)=>{var n=cf(),i=L(n);q(i,21,()=>V(r),Gr,(e,t)=>{var n=tf(),r=I(n),i=R(r,!0),a=z(r),o=e=>{var n=Qd(),r=R(n,!0);B(()=>G(r,V(t).detail)),W(e,n)};K(a,e=>{V(t).detail&&e(o)});var s=z(a,2),l=e=>{var n=$d(),r=R(n,!0);B(e=>G(r,e),[()=>V(t).mend[0].toUpperCase()+V(t).mend.slice(1)]),H(`click`,n,()=>c(V(t))),W(e,n)},u=e=>{var n=ef(),r=R(n,!0);B(()=>G(r,V(t).mend)),W(e,n)};K(s,e=>{V(t).to?e(l):e(u,-1)}),A(n),B(()=>{fi(n,1,`note ${V(t).tone??``}`,`svelte-c5xi31`),G(i,V(t).text)}),W(e,n)},e=>{W(e,nf())}),A(i);var a=z(i,2),u=e=>{var t=sf(),n=z(L(t),2);q(n,21,()=>V(o),e=>e.name,(e,t)=>{let n=N(()=>X.lasers.find(e=>e.laser===V(t).name));var r=of(),i=I(r),a=I(i),o=R(a,!0);q(z(a),16,()=>[`emission`,`shutter`],Gr,(e,n)=>{var r=Nr(),i=L(r),a=e=>{var r=rf(),i=L(r),a=R(z(i),!0);B(()=>{G(i,` · ${n??``} `),G(a,n===`emission`?V(t).values[n].value?`on`:`off`:V(t).values[n].value)}),W(e,r)};K(i,e=>{V(t).values[n]&&e(a)}),W(e,r)}),A(i);var c=z(i,2),u=e=>{var r=af(),i=L(r),a=R(i),o=z(i,2);lo(I(o),{small:!0,run:()=>X.did([`laser`,`disarm`,V(t).name]),get barred(){return V(s)},children:(e,t)=>{Ce(),W(e,Mr(`Shut it`))},$$slots:{default:!0}}),A(o),B(e=>G(a,`Class ${V(n).laser_class??``}, ${V(n).emits?`emits`:`emits nothing`}; ${e??``}.`),[()=>l(V(n))]),W(e,r)};K(c,e=>{V(n)&&e(u)}),A(r),B(()=>G(o,V(t).name)),W(e,r)}),A(n),ko(z(n,2),{words:[`laser`]}),W(e,t)};K(a,e=>{V(o).length&&e(u)}),W(e,n)},$$slots:{default:!0}})};K(v,e=>{V(n)&&e(y)}),B(()=>fi(m,1,`badge ${V(i)??``}`,`svelte-c5xi31`)),H(`click`,d,()=>{F(n,!0),V(o).length&&X.lit()}),W(e,u),He()}Sr([`click`]);var df=U(`<p class="dim"> </p>`),ff=U(`<p><strong> </strong> </p> <!>`,1),pf=U(`<p> </p>`),mf=U(`<label for="reason"> </label> <input id="reason" maxlength="500" placeholder="They are told this"/> <div class="row"><!></div> <!>`,1),hf=U(`<!> <!> <div class="row"><!></div> <!>`,1),gf=U(`<button class="chip svelte-ig6d0v" title="Who has the bench"><span><span class="wide svelte-ig6d0v">Bench:</span> <!></span></button> <!>`,1);function _f(e,t){Ve(t,!0);let n=P(!1),r=P(``),i=N(()=>Y.lease?.holder??null),a=N(()=>Y.mine&&Y.token!==null),o=N(()=>V(i)?.you===!0&&!Y.mine&&!!(V(i).run||yc.begun||Y.runs)),s=N(()=>V(i)?.you===!0&&!Y.mine&&!Y.runs),c=N(()=>V(i)?V(a)?`yours`:V(o)?`your run`:V(s)?`you, elsewhere`:V(i).you?`yours`:V(i).who:`free`),l=N(()=>aa.may(`lease:steal`,Y.lab)?V(r).trim()?null:`say why: it is told to who has it`:`taking over needs the role lease:steal`),u=N(()=>aa.may(`operator`,Y.lab)?null:`needs the role operator`);var d=gf(),f=L(d),p=I(f);let m;var h=z(I(p)),g=z(h),_=e=>{var t=Mr();B(()=>G(t,` +${Y.lease.waiting.length??``}`)),W(e,t)};K(g,e=>{Y.lease?.waiting.length&&e(_)}),A(p),A(f);var v=z(f,2),y=e=>{uc(e,{title:`Who has the bench`,close:()=>F(n,!1),children:(e,t)=>{var n=hf(),o=L(n),c=e=>{var t=ff(),n=L(t),r=I(n),a=R(r,!0),o=z(r);A(n);var c=z(n,2),l=e=>{var t=df(),n=R(t);B(e=>G(n,`Held until it is given back; ${e??``} left before it must be renewed.`),[()=>Co(Math.max(0,V(i).left))]),W(e,t)};K(c,e=>{V(i).run||e(l)}),B(()=>{G(a,V(i).you?`You have`:`${V(i).who} has`),G(o,` ${Y.name??``}${V(i).run?`, for a run that goes on`:yc.begun?`, and steer it`:Y.runs?`, for a run that goes on`:V(s)?`, in another page or terminal of yours`:``}.`)}),W(e,t)},d=e=>{var t=pf(),n=R(t);B(()=>G(n,`Nobody has ${Y.name??``}. Commands that move it take it for as long as they need.`)),W(e,t)};K(o,e=>{V(i)?e(c):e(d,-1)});var f=z(o,2),p=e=>{var t=pf(),n=R(t);B(e=>G(n,`Waiting: ${e??``}`),[()=>Y.lease.waiting.join(`, `)]),W(e,t)};K(f,e=>{Y.lease?.waiting.length&&e(p)});var m=z(f,2),h=I(m),g=e=>{lo(e,{run:()=>Y.release(),main:!0,children:(e,t)=>{Ce(),W(e,Mr(`Give it back`))},$$slots:{default:!0}})},_=e=>{lo(e,{run:()=>Y.release(),children:(e,t)=>{Ce(),W(e,Mr(`Wait no more`))},$$slots:{default:!0}})},v=e=>{lo(e,{run:()=>Y.take(),get barred(){return V(u)},main:!0,children:(e,t)=>{Ce();var n=Mr();B(()=>G(n,V(i)&&!Y.mine?`Ask for it`:`Take it`)),W(e,n)},$$slots:{default:!0}})};K(h,e=>{V(a)?e(g):Y.waits?e(_,1):e(v,-1)}),A(m);var y=z(m,2),b=e=>{var t=mf(),n=L(t),a=R(n),o=z(n,2);Ei(o);var c=z(o,2);lo(I(c),{run:()=>Y.steal(V(r)),get barred(){return V(l)},children:(e,t)=>{Ce(),W(e,Mr(`Take over`))},$$slots:{default:!0}}),A(c);var u=z(c,2);{let e=N(()=>[`lease`,`steal`,`--reason`,V(r)||`…`]);ko(u,{get words(){return V(e)}})}B(()=>G(a,`Take it over from ${(V(s)?`your other page or terminal`:Y.runs?`your own run`:V(i).who)??``}. Why?`)),ji(o,()=>V(r),e=>F(r,e)),W(e,t)},x=e=>{{let t=N(()=>[`lease`,V(a)?`release`:`take`]);ko(e,{get words(){return V(t)}})}};K(y,e=>{V(i)&&!Y.mine?e(b):e(x,-1)}),W(e,n)},$$slots:{default:!0}})};K(v,e=>{V(n)&&e(y)}),B(()=>{m=fi(p,1,`badge ${V(i)?V(a)?`accent`:`warn`:``}`,`svelte-ig6d0v`,m,{turn:Y.turn}),G(h,` ${V(c)??``}`)}),H(`click`,f,()=>{F(n,!0),Y.turn=!1}),W(e,d),He()}Sr([`click`]);var vf=U(`<option> </option>`),yf=U(`<label class="hidden" for="bench">Bench</label> <select id="bench"></select>`,1),bf=U(`<span class="mono cut wide svelte-ge5qer"> </span>`),xf=U(`<span class="badge warn mid svelte-ge5qer" title="Values of the manifest that are in no commit"> </span>`),Sf=U(`<span class="badge mid svelte-ge5qer" title="The commit that is checked out"> </span> <!> <button class="small bare mid svelte-ge5qer" title="Desired against live: how many values differ"><span> </span></button>`,1),Cf=U(`<header class="svelte-ge5qer"><button class="bare only-narrow svelte-ge5qer" aria-label="Components">☰</button> <strong class="brand svelte-ge5qer">PICO</strong> <!> <!> <span class="grow"></span> <span role="status" title="The line to the bench"><span class="dot svelte-ge5qer"></span><span class="wide svelte-ge5qer"> </span></span> <!> <!> <button class="bare mid svelte-ge5qer" title="All commands (Ctrl K)">⌘<span class="wide space svelte-ge5qer">Commands</span></button> <button class="bare mid svelte-ge5qer"> </button> <button class="stop svelte-ge5qer" title="Stop at once: arms brake, shutters close, grippers hold. Anybody may (Ctrl .)">STOP</button></header>`);function wf(e,t){Ve(t,!0);let n=N(()=>X.status?.rows??[]),r=N(()=>V(n).filter(e=>e.off).length),i=N(()=>V(n).filter(e=>e.edited).length),a=N(()=>Y.line===`open`&&Y.edge===`away`?[`bad`,`bench away`]:{opening:[`warn`,`connecting`],open:[`ok`,`connected`],lost:[`bad`,`line lost`]}[Y.line]);var o=Cf(),s=I(o),c=z(s,4),l=e=>{var t=yf(),n=z(L(t),2);q(n,21,()=>aa.benches,Gr,(e,t)=>{var n=vf(),r=R(n,!0),i={};B(()=>{G(r,V(t).bench),i!==(i=V(t).bench)&&(n.__value=i)}),W(e,n)}),A(n);var r;vi(n),B(()=>{r!==(r=Y.name)&&(n.value=(n.__value=r)??``,_i(n,r))}),H(`change`,n,e=>Gi.open(e.currentTarget.value)),W(e,t)},u=e=>{var t=bf(),n=R(t,!0);B(()=>G(n,Y.name??``)),W(e,t)};K(c,e=>{aa.benches.length>1?e(l):e(u,-1)});var d=z(c,2),f=e=>{var t=Sf(),n=L(t),a=R(n,!0),o=z(n,2),s=e=>{var t=xf(),n=R(t);B(()=>G(n,`${V(i)??``} edited`)),W(e,t)};K(o,e=>{V(i)&&e(s)});var c=z(o,2),l=I(c),u=R(l,!0);A(c),B(()=>{G(a,X.status.head||`no commit`),fi(l,1,`badge ${V(r)?`warn`:`ok`}`),G(u,V(r)?`${V(r)} out of sync`:`in sync`)}),H(`click`,c,()=>Gi.go(`plan`)),W(e,t)};K(d,e=>{X.status&&e(f)});var p=z(d,4),m=R(z(I(p)),!0);A(p);var h=z(p,2);uf(h,{});var g=z(h,2);_f(g,{});var _=z(g,2),v=z(_,2),y=R(v,!0),b=z(v,2);A(o),B(()=>{fi(p,1,`badge ${V(a)[0]??``} health`,`svelte-ge5qer`),G(m,V(a)[1]),J(v,`aria-label`,`${Ao.shown===`dark`?`Light`:`Dark`} colours`),G(y,Ao.shown===`dark`?`☀`:`☾`),b.disabled=!Y.name}),H(`click`,s,function(...e){t.parts?.apply(this,e)}),H(`click`,_,function(...e){t.palette?.apply(this,e)}),H(`click`,v,function(...e){Ao.turn?.apply(this,e)}),H(`click`,b,()=>Y.stop()),W(e,o),He()}Sr([`click`,`change`]);var Tf=16,Ef=150,Df=class{#e=new Map;#t=new Map;#n=null;#r=0;#i=0;push(e,t){let n=this.#n,r=n===null||n.epoch!==e.epoch||Math.abs(e.time-n.time)>1.5;n&&n.epoch!==e.epoch&&(this.#e.clear(),this.#t.clear());let i=this.#a(t);for(let[e,t]of this.#e)this.#e.set(e,{from:Of(t,i),to:t.to});for(let[e,t]of this.#t)this.#t.set(e,{from:kf(t,i),to:t.to});for(let t of e.arms)this.#e.set(t.index,{from:!r&&this.#e.get(t.index)?.from||t,to:t});for(let t of e.bodies)this.#t.set(t.index,{from:!r&&this.#t.get(t.index)?.from||t,to:t});this.#i=r?0:Math.max(Tf,Math.min(Ef,t-this.#r)),this.#r=t,this.#n=e}at(e,t=!1){let n=this.#a(e),{epoch:r=0,rev:i=0,time:a=0,arms:o=[],bodies:s=[]}=this.#n??{},c=e=>n=>t||n.from!==n.to||e.includes(n.to);return{epoch:r,rev:i,time:a,arms:[...this.#e.values()].filter(c(o)).map(e=>Of(e,n)),bodies:[...this.#t.values()].filter(c(s)).map(e=>kf(e,n))}}over(e){return this.#a(e)>=1}#a(e){return this.#i?Math.max(0,Math.min(1,(e-this.#r)/this.#i)):1}};function Of({from:e,to:t},n){return n>=1||e===t?t:{index:t.index,joints:Float32Array.from(ga(e.joints,t.joints,n)),gripper:e.gripper+n*(t.gripper-e.gripper)}}function kf({from:e,to:t},n){if(n>=1||e===t)return t;let[r=0,i=0,a=0]=ga(e.position,t.position,n);return{index:t.index,position:[r,i,a],quaternion:_a(e.quaternion,t.quaternion,n)}}var Af=U(`<p> </p>`),jf=U(`<p>Drag a component, or choose one and use the arrow keys.</p>`),Mf=U(`<br/><span class="dim"> </span>`,1),Nf=U(` <!>`,1),Pf=U(`<p class="mono number"><strong> </strong> </p> <p role="status"><!></p>`,1),Ff=U(`Undo<!>`,1),If=U(`<section class="hand svelte-1nvkzyg" aria-label="Edit by hand"><!> <div class="row svelte-1nvkzyg"><!> <button class="small" title="Escape">Leave it</button> <!> <label class="row svelte-1nvkzyg"><input type="checkbox" class="svelte-1nvkzyg"/> to holes</label> <span class="grow"></span> <button class="small bare" aria-label="End editing by hand">✕</button></div></section>`);function Lf(e,t){Ve(t,!0);let n=zi(t,`twin`,7),r=N(()=>uu.pose),i=N(()=>uu.barred??(uu.changed?uu.checked===`wrong`?`it can't stand there`:null:`move it first`));_n(()=>{if(!n())return;let e=uu.on;return n().drag={always:e,begin(e,t){let n=Y.scene?.components.find(t=>t.index===e)?.name;return!n||!uu.take(n)?!1:(uu.on=!0,Gi.go(`inspect`,{part:n}),uu.grip(t),!0)},over:e=>uu.over(e),end:()=>void uu.write()},()=>{n().drag=null}}),_n(()=>{let e=Gi.now.query.part;fr(()=>{uu.on&&e&&e!==uu.name&&uu.take(e)})}),_n(()=>{uu.on&&uu.name&&n()?.canvas.focus({preventScroll:!0})});var a=Nr(),o=L(a),s=e=>{var t=If(),n=I(t),a=e=>{var t=Af(),n=R(t,!0);B(()=>G(n,uu.barred)),W(e,t)},o=e=>{W(e,jf())},s=e=>{var t=Pf(),n=L(t),i=I(n),a=R(i,!0),o=z(i);A(n);var s=z(n,2),c=I(s),l=e=>{W(e,Mr(`Checking …`))},u=e=>{W(e,Mr(`It fits: room, reach and beam.`))},d=e=>{var t=Nf(),n=L(t,!0),r=z(n),i=e=>{var t=Mf(),n=R(z(L(t)),!0);B(()=>G(n,uu.faults[0].hint)),W(e,t)};K(r,e=>{uu.faults[0]?.hint&&e(i)}),B(()=>G(n,uu.faults[0]?.summary??`It can't stand there.`)),W(e,t)},f=e=>{W(e,Mr(`Drag it; arrows move, R and E turn, Shift is fine.`))};K(c,e=>{uu.checked===`checking`?e(l):uu.checked===`fits`?e(u,1):uu.checked===`wrong`?e(d,2):e(f,-1)}),A(s),B((e,t,n)=>{G(a,uu.name),G(o,` x ${e??``} mm, y ${t??``} mm, yaw ${n??``}°`),fi(s,1,oi(uu.checked===`wrong`?`bad`:uu.checked===`fits`?`ok`:`dim`))},[()=>V(r).x.toFixed(1),()=>V(r).y.toFixed(1),()=>V(r).yaw.toFixed(1)]),W(e,t)};K(n,e=>{uu.barred?e(a):V(r)?e(s,-1):e(o,1)});var c=z(n,2),l=I(c);lo(l,{small:!0,main:!0,run:()=>uu.write(),get barred(){return V(i)},title:`Enter`,children:(e,t)=>{Ce(),W(e,Mr(`Write`))},$$slots:{default:!0}});var u=z(l,2),d=z(u,2);{let e=N(()=>uu.undo.length?null:`nothing was written by hand`);lo(d,{small:!0,run:()=>uu.back(),get barred(){return V(e)},children:(e,t)=>{Ce();var n=Ff(),r=z(L(n)),i=e=>{var t=Mr();B(()=>G(t,` ${uu.undo.length??``}`)),W(e,t)};K(r,e=>{uu.undo.length&&e(i)}),W(e,n)},$$slots:{default:!0}})}var f=z(d,2),p=I(f);Ei(p),Ce(),A(f);var m=z(f,4);A(c),A(t),B(()=>u.disabled=!uu.changed),H(`click`,u,()=>uu.leave()),Mi(p,()=>uu.snap,e=>uu.snap=e),H(`click`,m,function(...e){uu.turn?.apply(this,e)}),W(e,t)};K(o,e=>{uu.on&&e(s)}),W(e,a),He()}Sr([`click`]);var Rf={LEFT:0,MIDDLE:1,RIGHT:2,ROTATE:0,DOLLY:1,PAN:2},zf={ROTATE:0,PAN:1,DOLLY_PAN:2,DOLLY_ROTATE:3},Bf=1e3,Vf=1001,Hf=1002,Uf=1003,Wf=1004,Gf=1005,Kf=1006,qf=1007,Jf=1008,Yf=1009,Xf=1010,Zf=1011,Qf=1012,$f=1013,ep=1014,tp=1015,np=1016,rp=1017,ip=1018,ap=1020,op=35902,sp=35899,cp=1021,lp=1022,up=1023,dp=1026,fp=1027,pp=1028,mp=1029,hp=1030,gp=1031,_p=1033,vp=33776,yp=33777,bp=33778,xp=33779,Sp=35840,Cp=35841,wp=35842,Tp=35843,Ep=36196,Dp=37492,Op=37496,kp=37488,Ap=37489,jp=37490,Mp=37491,Np=37808,Pp=37809,Fp=37810,Ip=37811,Lp=37812,Rp=37813,zp=37814,Bp=37815,Vp=37816,Hp=37817,Up=37818,Wp=37819,Gp=37820,Kp=37821,qp=36492,Jp=36494,Yp=36495,Xp=36283,Zp=36284,Qp=36285,$p=36286,em=2300,tm=2301,nm=2302,rm=2303,im=2400,am=2401,om=2402,sm=3200,cm=`srgb`,lm=`srgb-linear`,um=`linear`,dm=`srgb`,fm=7680,pm=35044,mm=2e3;function hm(e){for(let t=e.length-1;t>=0;--t)if(e[t]>=65535)return!0;return!1}function gm(e){return ArrayBuffer.isView(e)&&!(e instanceof DataView)}function _m(e){return document.createElementNS(`http://www.w3.org/1999/xhtml`,e)}function vm(){let e=_m(`canvas`);return e.style.display=`block`,e}var ym={};function bm(...e){let t=`THREE.`+e.shift();console.log(t,...e)}function xm(e){let t=e[0];if(typeof t==`string`&&t.startsWith(`TSL:`)){let t=e[1];t&&t.isStackTrace?e[0]+=` `+t.getLocation():e[1]=`Stack trace not available. Enable "THREE.Node.captureStackTrace" to capture stack traces.`}return e}function Sm(...e){e=xm(e);let t=`THREE.`+e.shift();{let n=e[0];n&&n.isStackTrace?console.warn(n.getError(t)):console.warn(t,...e)}}function Cm(...e){e=xm(e);let t=`THREE.`+e.shift();{let n=e[0];n&&n.isStackTrace?console.error(n.getError(t)):console.error(t,...e)}}function wm(...e){let t=e.join(` `);t in ym||(ym[t]=!0,Sm(...e))}function Tm(e,t,n){return new Promise(function(r,i){function a(){switch(e.clientWaitSync(t,e.SYNC_FLUSH_COMMANDS_BIT,0)){case e.WAIT_FAILED:i();break;case e.TIMEOUT_EXPIRED:setTimeout(a,n);break;default:r()}}setTimeout(a,n)})}var Em={0:0,2:6,4:4,3:5,1:1,6:2,7:7,5:3},Dm=class{addEventListener(e,t){this._listeners===void 0&&(this._listeners={});let n=this._listeners;n[e]===void 0&&(n[e]=[]),n[e].indexOf(t)===-1&&n[e].push(t)}hasEventListener(e,t){let n=this._listeners;return n!==void 0&&n[e]!==void 0&&n[e].indexOf(t)!==-1}removeEventListener(e,t){let n=this._listeners;if(n===void 0)return;let r=n[e];if(r!==void 0){let e=r.indexOf(t);e!==-1&&r.splice(e,1)}}dispatchEvent(e){let t=this._listeners;if(t===void 0)return;let n=t[e.type];if(n!==void 0){e.target=this;let t=n.slice(0);for(let n=0,r=t.length;n<r;n++)t[n].call(this,e);e.target=null}}},Om=`00.01.02.03.04.05.06.07.08.09.0a.0b.0c.0d.0e.0f.10.11.12.13.14.15.16.17.18.19.1a.1b.1c.1d.1e.1f.20.21.22.23.24.25.26.27.28.29.2a.2b.2c.2d.2e.2f.30.31.32.33.34.35.36.37.38.39.3a.3b.3c.3d.3e.3f.40.41.42.43.44.45.46.47.48.49.4a.4b.4c.4d.4e.4f.50.51.52.53.54.55.56.57.58.59.5a.5b.5c.5d.5e.5f.60.61.62.63.64.65.66.67.68.69.6a.6b.6c.6d.6e.6f.70.71.72.73.74.75.76.77.78.79.7a.7b.7c.7d.7e.7f.80.81.82.83.84.85.86.87.88.89.8a.8b.8c.8d.8e.8f.90.91.92.93.94.95.96.97.98.99.9a.9b.9c.9d.9e.9f.a0.a1.a2.a3.a4.a5.a6.a7.a8.a9.aa.ab.ac.ad.ae.af.b0.b1.b2.b3.b4.b5.b6.b7.b8.b9.ba.bb.bc.bd.be.bf.c0.c1.c2.c3.c4.c5.c6.c7.c8.c9.ca.cb.cc.cd.ce.cf.d0.d1.d2.d3.d4.d5.d6.d7.d8.d9.da.db.dc.dd.de.df.e0.e1.e2.e3.e4.e5.e6.e7.e8.e9.ea.eb.ec.ed.ee.ef.f0.f1.f2.f3.f4.f5.f6.f7.f8.f9.fa.fb.fc.fd.fe.ff`.split(`.`),km=1234567,Am=Math.PI/180,jm=180/Math.PI;function Mm(){let e=Math.random()*4294967295|0,t=Math.random()*4294967295|0,n=Math.random()*4294967295|0,r=Math.random()*4294967295|0;return(Om[e&255]+Om[e>>8&255]+Om[e>>16&255]+Om[e>>24&255]+`-`+Om[t&255]+Om[t>>8&255]+`-`+Om[t>>16&15|64]+Om[t>>24&255]+`-`+Om[n&63|128]+Om[n>>8&255]+`-`+Om[n>>16&255]+Om[n>>24&255]+Om[r&255]+Om[r>>8&255]+Om[r>>16&255]+Om[r>>24&255]).toLowerCase()}function Nm(e,t,n){return Math.max(t,Math.min(n,e))}function Pm(e,t){return(e%t+t)%t}function Fm(e,t,n,r,i){return r+(e-t)*(i-r)/(n-t)}function Im(e,t,n){return e===t?0:(n-e)/(t-e)}function Lm(e,t,n){return(1-n)*e+n*t}function Rm(e,t,n,r){return Lm(e,t,1-Math.exp(-n*r))}function zm(e,t=1){return t-Math.abs(Pm(e,t*2)-t)}function Bm(e,t,n){return e<=t?0:e>=n?1:(e=(e-t)/(n-t),e*e*(3-2*e))}function Vm(e,t,n){return e<=t?0:e>=n?1:(e=(e-t)/(n-t),e*e*e*(e*(e*6-15)+10))}function Hm(e,t){return e+Math.floor(Math.random()*(t-e+1))}function Um(e,t){return e+Math.random()*(t-e)}function Wm(e){return e*(.5-Math.random())}function Gm(e){e!==void 0&&(km=e);let t=km+=1831565813;return t=Math.imul(t^t>>>15,t|1),t^=t+Math.imul(t^t>>>7,t|61),((t^t>>>14)>>>0)/4294967296}function Km(e){return e*Am}function qm(e){return e*jm}function Jm(e){return e>0&&Number.isInteger(e)&&2**Math.round(Math.log2(e))===e}function Ym(e){return 2**Math.ceil(Math.log(e)/Math.LN2)}function Xm(e){return 2**Math.floor(Math.log(e)/Math.LN2)}function Zm(e,t,n,r,i){let a=Math.cos,o=Math.sin,s=a(n/2),c=o(n/2),l=a((t+r)/2),u=o((t+r)/2),d=a((t-r)/2),f=o((t-r)/2),p=a((r-t)/2),m=o((r-t)/2);switch(i){case`XYX`:e.set(s*u,c*d,c*f,s*l);break;case`YZY`:e.set(c*f,s*u,c*d,s*l);break;case`ZXZ`:e.set(c*d,c*f,s*u,s*l);break;case`XZX`:e.set(s*u,c*m,c*p,s*l);break;case`YXY`:e.set(c*p,s*u,c*m,s*l);break;case`ZYZ`:e.set(c*m,c*p,s*u,s*l);break;default:Sm(`MathUtils: .setQuaternionFromProperEuler() encountered an unknown order: `+i)}}function Qm(e){switch(e.constructor){case Uint32Array:return 4294967295;case Uint16Array:return 65535;case Uint8Array:case Uint8ClampedArray:return 255;case Int32Array:return 2147483647;case Int16Array:return 32767;case Int8Array:return 127;default:return}}function $m(e,t){if(t.constructor===Float32Array)return e;let n=Qm(t);if(n===void 0)throw Error(`THREE.MathUtils: Invalid component type.`);return Math.max(e/n,-1)}function eh(e,t){if(t.constructor===Float32Array)return e;let n=Qm(t);if(n===void 0)throw Error(`THREE.MathUtils: Invalid component type.`);return Math.round(e*n)}var th={DEG2RAD:Am,RAD2DEG:jm,generateUUID:Mm,clamp:Nm,euclideanModulo:Pm,mapLinear:Fm,inverseLerp:Im,lerp:Lm,damp:Rm,pingpong:zm,smoothstep:Bm,smootherstep:Vm,randInt:Hm,randFloat:Um,randFloatSpread:Wm,seededRandom:Gm,degToRad:Km,radToDeg:qm,isPowerOfTwo:Jm,ceilPowerOfTwo:Ym,floorPowerOfTwo:Xm,setQuaternionFromProperEuler:Zm,normalize:eh,denormalize:$m},Z=class{static{this.prototype.isVector2=!0}constructor(e=0,t=0){this.x=e,this.y=t}get width(){return this.x}set width(e){this.x=e}get height(){return this.y}set height(e){this.y=e}set(e,t){return this.x=e,this.y=t,this}setScalar(e){return this.x=e,this.y=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;default:throw Error(`THREE.Vector2: index is out of range: `+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;default:throw Error(`THREE.Vector2: index is out of range: `+e)}}clone(){return new this.constructor(this.x,this.y)}copy(e){return this.x=e.x,this.y=e.y,this}add(e){return this.x+=e.x,this.y+=e.y,this}addScalar(e){return this.x+=e,this.y+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this}subScalar(e){return this.x-=e,this.y-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this}multiply(e){return this.x*=e.x,this.y*=e.y,this}multiplyScalar(e){return this.x*=e,this.y*=e,this}divide(e){return this.x/=e.x,this.y/=e.y,this}divideScalar(e){return this.multiplyScalar(1/e)}applyMatrix3(e){let t=this.x,n=this.y,r=e.elements;return this.x=r[0]*t+r[3]*n+r[6],this.y=r[1]*t+r[4]*n+r[7],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this}clamp(e,t){return this.x=Nm(this.x,e.x,t.x),this.y=Nm(this.y,e.y,t.y),this}clampScalar(e,t){return this.x=Nm(this.x,e,t),this.y=Nm(this.y,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(Nm(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this}negate(){return this.x=-this.x,this.y=-this.y,this}dot(e){return this.x*e.x+this.y*e.y}cross(e){return this.x*e.y-this.y*e.x}lengthSq(){return this.x*this.x+this.y*this.y}length(){return Math.sqrt(this.x*this.x+this.y*this.y)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)}normalize(){return this.divideScalar(this.length()||1)}angle(){return Math.atan2(-this.y,-this.x)+Math.PI}angleTo(e){let t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;let n=this.dot(e)/t;return Math.acos(Nm(n,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){let t=this.x-e.x,n=this.y-e.y;return t*t+n*n}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this}equals(e){return e.x===this.x&&e.y===this.y}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this}rotateAround(e,t){let n=Math.cos(t),r=Math.sin(t),i=this.x-e.x,a=this.y-e.y;return this.x=i*n-a*r+e.x,this.y=i*r+a*n+e.y,this}random(){return this.x=Math.random(),this.y=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y}},nh=class{constructor(e=0,t=0,n=0,r=1){this.isQuaternion=!0,this._x=e,this._y=t,this._z=n,this._w=r}static slerpFlat(e,t,n,r,i,a,o){let s=n[r+0],c=n[r+1],l=n[r+2],u=n[r+3],d=i[a+0],f=i[a+1],p=i[a+2],m=i[a+3];if(u!==m||s!==d||c!==f||l!==p){let e=s*d+c*f+l*p+u*m;e<0&&(d=-d,f=-f,p=-p,m=-m,e=-e);let t=1-o;if(e<.9995){let n=Math.acos(e),r=Math.sin(n);t=Math.sin(t*n)/r,o=Math.sin(o*n)/r,s=s*t+d*o,c=c*t+f*o,l=l*t+p*o,u=u*t+m*o}else{s=s*t+d*o,c=c*t+f*o,l=l*t+p*o,u=u*t+m*o;let e=1/Math.sqrt(s*s+c*c+l*l+u*u);s*=e,c*=e,l*=e,u*=e}}e[t]=s,e[t+1]=c,e[t+2]=l,e[t+3]=u}static multiplyQuaternionsFlat(e,t,n,r,i,a){let o=n[r],s=n[r+1],c=n[r+2],l=n[r+3],u=i[a],d=i[a+1],f=i[a+2],p=i[a+3];return e[t]=o*p+l*u+s*f-c*d,e[t+1]=s*p+l*d+c*u-o*f,e[t+2]=c*p+l*f+o*d-s*u,e[t+3]=l*p-o*u-s*d-c*f,e}get x(){return this._x}set x(e){this._x=e,this._onChangeCallback()}get y(){return this._y}set y(e){this._y=e,this._onChangeCallback()}get z(){return this._z}set z(e){this._z=e,this._onChangeCallback()}get w(){return this._w}set w(e){this._w=e,this._onChangeCallback()}set(e,t,n,r){return this._x=e,this._y=t,this._z=n,this._w=r,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._w)}copy(e){return this._x=e.x,this._y=e.y,this._z=e.z,this._w=e.w,this._onChangeCallback(),this}setFromEuler(e,t=!0){let n=e._x,r=e._y,i=e._z,a=e._order,o=Math.cos,s=Math.sin,c=o(n/2),l=o(r/2),u=o(i/2),d=s(n/2),f=s(r/2),p=s(i/2);switch(a){case`XYZ`:this._x=d*l*u+c*f*p,this._y=c*f*u-d*l*p,this._z=c*l*p+d*f*u,this._w=c*l*u-d*f*p;break;case`YXZ`:this._x=d*l*u+c*f*p,this._y=c*f*u-d*l*p,this._z=c*l*p-d*f*u,this._w=c*l*u+d*f*p;break;case`ZXY`:this._x=d*l*u-c*f*p,this._y=c*f*u+d*l*p,this._z=c*l*p+d*f*u,this._w=c*l*u-d*f*p;break;case`ZYX`:this._x=d*l*u-c*f*p,this._y=c*f*u+d*l*p,this._z=c*l*p-d*f*u,this._w=c*l*u+d*f*p;break;case`YZX`:this._x=d*l*u+c*f*p,this._y=c*f*u+d*l*p,this._z=c*l*p-d*f*u,this._w=c*l*u-d*f*p;break;case`XZY`:this._x=d*l*u-c*f*p,this._y=c*f*u-d*l*p,this._z=c*l*p+d*f*u,this._w=c*l*u+d*f*p;break;default:Sm(`Quaternion: .setFromEuler() encountered an unknown order: `+a)}return t===!0&&this._onChangeCallback(),this}setFromAxisAngle(e,t){let n=t/2,r=Math.sin(n);return this._x=e.x*r,this._y=e.y*r,this._z=e.z*r,this._w=Math.cos(n),this._onChangeCallback(),this}setFromRotationMatrix(e){let t=e.elements,n=t[0],r=t[4],i=t[8],a=t[1],o=t[5],s=t[9],c=t[2],l=t[6],u=t[10],d=n+o+u;if(d>0){let e=.5/Math.sqrt(d+1);this._w=.25/e,this._x=(l-s)*e,this._y=(i-c)*e,this._z=(a-r)*e}else if(n>o&&n>u){let e=2*Math.sqrt(1+n-o-u);this._w=(l-s)/e,this._x=.25*e,this._y=(r+a)/e,this._z=(i+c)/e}else if(o>u){let e=2*Math.sqrt(1+o-n-u);this._w=(i-c)/e,this._x=(r+a)/e,this._y=.25*e,this._z=(s+l)/e}else{let e=2*Math.sqrt(1+u-n-o);this._w=(a-r)/e,this._x=(i+c)/e,this._y=(s+l)/e,this._z=.25*e}return this._onChangeCallback(),this}setFromUnitVectors(e,t){let n=e.dot(t)+1;return n<1e-8?(n=0,Math.abs(e.x)>Math.abs(e.z)?(this._x=-e.y,this._y=e.x,this._z=0,this._w=n):(this._x=0,this._y=-e.z,this._z=e.y,this._w=n)):(this._x=e.y*t.z-e.z*t.y,this._y=e.z*t.x-e.x*t.z,this._z=e.x*t.y-e.y*t.x,this._w=n),this.normalize()}angleTo(e){return 2*Math.acos(Math.abs(Nm(this.dot(e),-1,1)))}rotateTowards(e,t){let n=this.angleTo(e);if(n===0)return this;let r=Math.min(1,t/n);return this.slerp(e,r),this}identity(){return this.set(0,0,0,1)}invert(){return this.conjugate()}conjugate(){return this._x*=-1,this._y*=-1,this._z*=-1,this._onChangeCallback(),this}dot(e){return this._x*e._x+this._y*e._y+this._z*e._z+this._w*e._w}lengthSq(){return this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w}length(){return Math.sqrt(this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w)}normalize(){let e=this.length();return e===0?(this._x=0,this._y=0,this._z=0,this._w=1):(e=1/e,this._x*=e,this._y*=e,this._z*=e,this._w*=e),this._onChangeCallback(),this}multiply(e){return this.multiplyQuaternions(this,e)}premultiply(e){return this.multiplyQuaternions(e,this)}multiplyQuaternions(e,t){let n=e._x,r=e._y,i=e._z,a=e._w,o=t._x,s=t._y,c=t._z,l=t._w;return this._x=n*l+a*o+r*c-i*s,this._y=r*l+a*s+i*o-n*c,this._z=i*l+a*c+n*s-r*o,this._w=a*l-n*o-r*s-i*c,this._onChangeCallback(),this}slerp(e,t){let n=e._x,r=e._y,i=e._z,a=e._w,o=this.dot(e);o<0&&(n=-n,r=-r,i=-i,a=-a,o=-o);let s=1-t;if(o<.9995){let e=Math.acos(o),c=Math.sin(e);s=Math.sin(s*e)/c,t=Math.sin(t*e)/c,this._x=this._x*s+n*t,this._y=this._y*s+r*t,this._z=this._z*s+i*t,this._w=this._w*s+a*t,this._onChangeCallback()}else this._x=this._x*s+n*t,this._y=this._y*s+r*t,this._z=this._z*s+i*t,this._w=this._w*s+a*t,this.normalize();return this}slerpQuaternions(e,t,n){return this.copy(e).slerp(t,n)}random(){let e=2*Math.PI*Math.random(),t=2*Math.PI*Math.random(),n=Math.random(),r=Math.sqrt(1-n),i=Math.sqrt(n);return this.set(r*Math.sin(e),r*Math.cos(e),i*Math.sin(t),i*Math.cos(t))}equals(e){return e._x===this._x&&e._y===this._y&&e._z===this._z&&e._w===this._w}fromArray(e,t=0){return this._x=e[t],this._y=e[t+1],this._z=e[t+2],this._w=e[t+3],this._onChangeCallback(),this}toArray(e=[],t=0){return e[t]=this._x,e[t+1]=this._y,e[t+2]=this._z,e[t+3]=this._w,e}fromBufferAttribute(e,t){return this._x=e.getX(t),this._y=e.getY(t),this._z=e.getZ(t),this._w=e.getW(t),this._onChangeCallback(),this}toJSON(){return this.toArray()}_onChange(e){return this._onChangeCallback=e,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._w}},Q=class{static{this.prototype.isVector3=!0}constructor(e=0,t=0,n=0){this.x=e,this.y=t,this.z=n}set(e,t,n){return n===void 0&&(n=this.z),this.x=e,this.y=t,this.z=n,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;default:throw Error(`THREE.Vector3: index is out of range: `+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;default:throw Error(`THREE.Vector3: index is out of range: `+e)}}clone(){return new this.constructor(this.x,this.y,this.z)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this}multiplyVectors(e,t){return this.x=e.x*t.x,this.y=e.y*t.y,this.z=e.z*t.z,this}applyEuler(e){return this.applyQuaternion(ih.setFromEuler(e))}applyAxisAngle(e,t){return this.applyQuaternion(ih.setFromAxisAngle(e,t))}applyMatrix3(e){let t=this.x,n=this.y,r=this.z,i=e.elements;return this.x=i[0]*t+i[3]*n+i[6]*r,this.y=i[1]*t+i[4]*n+i[7]*r,this.z=i[2]*t+i[5]*n+i[8]*r,this}applyNormalMatrix(e){return this.applyMatrix3(e).normalize()}applyMatrix4(e){let t=this.x,n=this.y,r=this.z,i=e.elements,a=1/(i[3]*t+i[7]*n+i[11]*r+i[15]);return this.x=(i[0]*t+i[4]*n+i[8]*r+i[12])*a,this.y=(i[1]*t+i[5]*n+i[9]*r+i[13])*a,this.z=(i[2]*t+i[6]*n+i[10]*r+i[14])*a,this}applyQuaternion(e){let t=this.x,n=this.y,r=this.z,i=e.x,a=e.y,o=e.z,s=e.w,c=2*(a*r-o*n),l=2*(o*t-i*r),u=2*(i*n-a*t);return this.x=t+s*c+a*u-o*l,this.y=n+s*l+o*c-i*u,this.z=r+s*u+i*l-a*c,this}project(e){return this.applyMatrix4(e.matrixWorldInverse).applyMatrix4(e.projectionMatrix)}unproject(e){return this.applyMatrix4(e.projectionMatrixInverse).applyMatrix4(e.matrixWorld)}transformDirection(e){let t=this.x,n=this.y,r=this.z,i=e.elements;return this.x=i[0]*t+i[4]*n+i[8]*r,this.y=i[1]*t+i[5]*n+i[9]*r,this.z=i[2]*t+i[6]*n+i[10]*r,this.normalize()}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this}divideScalar(e){return this.multiplyScalar(1/e)}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this}clamp(e,t){return this.x=Nm(this.x,e.x,t.x),this.y=Nm(this.y,e.y,t.y),this.z=Nm(this.z,e.z,t.z),this}clampScalar(e,t){return this.x=Nm(this.x,e,t),this.y=Nm(this.y,e,t),this.z=Nm(this.z,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(Nm(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this.z=e.z+(t.z-e.z)*n,this}cross(e){return this.crossVectors(this,e)}crossVectors(e,t){let n=e.x,r=e.y,i=e.z,a=t.x,o=t.y,s=t.z;return this.x=r*s-i*o,this.y=i*a-n*s,this.z=n*o-r*a,this}projectOnVector(e){let t=e.lengthSq();if(t===0)return this.set(0,0,0);let n=e.dot(this)/t;return this.copy(e).multiplyScalar(n)}projectOnPlane(e){return rh.copy(this).projectOnVector(e),this.sub(rh)}reflect(e){return this.sub(rh.copy(e).multiplyScalar(2*this.dot(e)))}angleTo(e){let t=Math.sqrt(this.lengthSq()*e.lengthSq());if(t===0)return Math.PI/2;let n=this.dot(e)/t;return Math.acos(Nm(n,-1,1))}distanceTo(e){return Math.sqrt(this.distanceToSquared(e))}distanceToSquared(e){let t=this.x-e.x,n=this.y-e.y,r=this.z-e.z;return t*t+n*n+r*r}manhattanDistanceTo(e){return Math.abs(this.x-e.x)+Math.abs(this.y-e.y)+Math.abs(this.z-e.z)}setFromSpherical(e){return this.setFromSphericalCoords(e.radius,e.phi,e.theta)}setFromSphericalCoords(e,t,n){let r=Math.sin(t)*e;return this.x=r*Math.sin(n),this.y=Math.cos(t)*e,this.z=r*Math.cos(n),this}setFromCylindrical(e){return this.setFromCylindricalCoords(e.radius,e.theta,e.y)}setFromCylindricalCoords(e,t,n){return this.x=e*Math.sin(t),this.y=n,this.z=e*Math.cos(t),this}setFromMatrixPosition(e){let t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this}setFromMatrixScale(e){let t=this.setFromMatrixColumn(e,0).length(),n=this.setFromMatrixColumn(e,1).length(),r=this.setFromMatrixColumn(e,2).length();return this.x=t,this.y=n,this.z=r,this}setFromMatrixColumn(e,t){return this.fromArray(e.elements,t*4)}setFromMatrix3Column(e,t){return this.fromArray(e.elements,t*3)}setFromEuler(e){return this.x=e._x,this.y=e._y,this.z=e._z,this}setFromColor(e){return this.x=e.r,this.y=e.g,this.z=e.b,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this}randomDirection(){let e=Math.random()*Math.PI*2,t=Math.random()*2-1,n=Math.sqrt(1-t*t);return this.x=n*Math.cos(e),this.y=t,this.z=n*Math.sin(e),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z}},rh=new Q,ih=new nh,ah=class{static{this.prototype.isMatrix3=!0}constructor(e,t,n,r,i,a,o,s,c){this.elements=[1,0,0,0,1,0,0,0,1],e!==void 0&&this.set(e,t,n,r,i,a,o,s,c)}set(e,t,n,r,i,a,o,s,c){let l=this.elements;return l[0]=e,l[1]=r,l[2]=o,l[3]=t,l[4]=i,l[5]=s,l[6]=n,l[7]=a,l[8]=c,this}identity(){return this.set(1,0,0,0,1,0,0,0,1),this}copy(e){let t=this.elements,n=e.elements;return t[0]=n[0],t[1]=n[1],t[2]=n[2],t[3]=n[3],t[4]=n[4],t[5]=n[5],t[6]=n[6],t[7]=n[7],t[8]=n[8],this}extractBasis(e,t,n){return e.setFromMatrix3Column(this,0),t.setFromMatrix3Column(this,1),n.setFromMatrix3Column(this,2),this}setFromMatrix4(e){let t=e.elements;return this.set(t[0],t[4],t[8],t[1],t[5],t[9],t[2],t[6],t[10]),this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){let n=e.elements,r=t.elements,i=this.elements,a=n[0],o=n[3],s=n[6],c=n[1],l=n[4],u=n[7],d=n[2],f=n[5],p=n[8],m=r[0],h=r[3],g=r[6],_=r[1],v=r[4],y=r[7],b=r[2],x=r[5],S=r[8];return i[0]=a*m+o*_+s*b,i[3]=a*h+o*v+s*x,i[6]=a*g+o*y+s*S,i[1]=c*m+l*_+u*b,i[4]=c*h+l*v+u*x,i[7]=c*g+l*y+u*S,i[2]=d*m+f*_+p*b,i[5]=d*h+f*v+p*x,i[8]=d*g+f*y+p*S,this}multiplyScalar(e){let t=this.elements;return t[0]*=e,t[3]*=e,t[6]*=e,t[1]*=e,t[4]*=e,t[7]*=e,t[2]*=e,t[5]*=e,t[8]*=e,this}determinant(){let e=this.elements,t=e[0],n=e[1],r=e[2],i=e[3],a=e[4],o=e[5],s=e[6],c=e[7],l=e[8];return t*a*l-t*o*c-n*i*l+n*o*s+r*i*c-r*a*s}invert(){let e=this.elements,t=e[0],n=e[1],r=e[2],i=e[3],a=e[4],o=e[5],s=e[6],c=e[7],l=e[8],u=l*a-o*c,d=o*s-l*i,f=c*i-a*s,p=t*u+n*d+r*f;if(p===0)return this.set(0,0,0,0,0,0,0,0,0);let m=1/p;return e[0]=u*m,e[1]=(r*c-l*n)*m,e[2]=(o*n-r*a)*m,e[3]=d*m,e[4]=(l*t-r*s)*m,e[5]=(r*i-o*t)*m,e[6]=f*m,e[7]=(n*s-c*t)*m,e[8]=(a*t-n*i)*m,this}transpose(){let e,t=this.elements;return e=t[1],t[1]=t[3],t[3]=e,e=t[2],t[2]=t[6],t[6]=e,e=t[5],t[5]=t[7],t[7]=e,this}getNormalMatrix(e){return this.setFromMatrix4(e).invert().transpose()}transposeIntoArray(e){let t=this.elements;return e[0]=t[0],e[1]=t[3],e[2]=t[6],e[3]=t[1],e[4]=t[4],e[5]=t[7],e[6]=t[2],e[7]=t[5],e[8]=t[8],this}setUvTransform(e,t,n,r,i,a,o){let s=Math.cos(i),c=Math.sin(i);return this.set(n*s,n*c,-n*(s*a+c*o)+a+e,-r*c,r*s,-r*(-c*a+s*o)+o+t,0,0,1),this}scale(e,t){return wm(`Matrix3: .scale() is deprecated. Use .makeScale() instead.`),this.premultiply(oh.makeScale(e,t)),this}rotate(e){return wm(`Matrix3: .rotate() is deprecated. Use .makeRotation() instead.`),this.premultiply(oh.makeRotation(-e)),this}translate(e,t){return wm(`Matrix3: .translate() is deprecated. Use .makeTranslation() instead.`),this.premultiply(oh.makeTranslation(e,t)),this}makeTranslation(e,t){return e.isVector2?this.set(1,0,e.x,0,1,e.y,0,0,1):this.set(1,0,e,0,1,t,0,0,1),this}makeRotation(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,-n,0,n,t,0,0,0,1),this}makeScale(e,t){return this.set(e,0,0,0,t,0,0,0,1),this}equals(e){let t=this.elements,n=e.elements;for(let e=0;e<9;e++)if(t[e]!==n[e])return!1;return!0}fromArray(e,t=0){for(let n=0;n<9;n++)this.elements[n]=e[n+t];return this}toArray(e=[],t=0){let n=this.elements;return e[t]=n[0],e[t+1]=n[1],e[t+2]=n[2],e[t+3]=n[3],e[t+4]=n[4],e[t+5]=n[5],e[t+6]=n[6],e[t+7]=n[7],e[t+8]=n[8],e}clone(){return new this.constructor().fromArray(this.elements)}},oh=new ah,sh=new ah().set(.4123908,.3575843,.1804808,.212639,.7151687,.0721923,.0193308,.1191948,.9505322),ch=new ah().set(3.2409699,-1.5373832,-.4986108,-.9692436,1.8759675,.0415551,.0556301,-.203977,1.0569715);function lh(){let e={enabled:!0,workingColorSpace:lm,spaces:{},convert:function(e,t,n){return this.enabled===!1||t===n||!t||!n||(this.spaces[t].transfer===`srgb`&&(e.r=dh(e.r),e.g=dh(e.g),e.b=dh(e.b)),this.spaces[t].primaries!==this.spaces[n].primaries&&(e.applyMatrix3(this.spaces[t].toXYZ),e.applyMatrix3(this.spaces[n].fromXYZ)),this.spaces[n].transfer===`srgb`&&(e.r=fh(e.r),e.g=fh(e.g),e.b=fh(e.b))),e},workingToColorSpace:function(e,t){return this.convert(e,this.workingColorSpace,t)},colorSpaceToWorking:function(e,t){return this.convert(e,t,this.workingColorSpace)},getPrimaries:function(e){return this.spaces[e].primaries},getTransfer:function(e){return e===``?um:this.spaces[e].transfer},getToneMappingMode:function(e){return this.spaces[e].outputColorSpaceConfig.toneMappingMode||`standard`},getLuminanceCoefficients:function(e,t=this.workingColorSpace){return e.fromArray(this.spaces[t].luminanceCoefficients)},define:function(e){Object.assign(this.spaces,e)},_getMatrix:function(e,t,n){return e.copy(this.spaces[n].fromXYZ).multiply(this.spaces[t].toXYZ)},_getDrawingBufferColorSpace:function(e){return this.spaces[e].outputColorSpaceConfig.drawingBufferColorSpace},_getUnpackColorSpace:function(e=this.workingColorSpace){return this.spaces[e].workingColorSpaceConfig.unpackColorSpace}},t=[.64,.33,.3,.6,.15,.06],n=[.2126,.7152,.0722],r=[.3127,.329];return e.define({[lm]:{primaries:t,whitePoint:r,transfer:um,toXYZ:sh,fromXYZ:ch,luminanceCoefficients:n,workingColorSpaceConfig:{unpackColorSpace:cm},outputColorSpaceConfig:{drawingBufferColorSpace:cm}},[cm]:{primaries:t,whitePoint:r,transfer:dm,toXYZ:sh,fromXYZ:ch,luminanceCoefficients:n,outputColorSpaceConfig:{drawingBufferColorSpace:cm}}}),e}var uh=lh();function dh(e){return e<.04045?e*.0773993808:(e*.9478672986+.0521327014)**2.4}function fh(e){return e<.0031308?e*12.92:1.055*e**.41666-.055}var ph,mh=class{static getDataURL(e,t=`image/png`){if(/^data:/i.test(e.src)||typeof HTMLCanvasElement>`u`)return e.src;let n;if(e instanceof HTMLCanvasElement)n=e;else{ph===void 0&&(ph=_m(`canvas`)),ph.width=e.width,ph.height=e.height;let t=ph.getContext(`2d`);e instanceof ImageData?t.putImageData(e,0,0):t.drawImage(e,0,0,e.width,e.height),n=ph}return n.toDataURL(t)}static sRGBToLinear(e){if(typeof HTMLImageElement<`u`&&e instanceof HTMLImageElement||typeof HTMLCanvasElement<`u`&&e instanceof HTMLCanvasElement||typeof ImageBitmap<`u`&&e instanceof ImageBitmap){let t=_m(`canvas`);t.width=e.width,t.height=e.height;let n=t.getContext(`2d`);n.drawImage(e,0,0,e.width,e.height);let r=n.getImageData(0,0,e.width,e.height),i=r.data;for(let e=0;e<i.length;e++)i[e]=dh(i[e]/255)*255;return n.putImageData(r,0,0),t}if(e.data){let t=e.data.slice(0);for(let e=0;e<t.length;e++)t instanceof Uint8Array||t instanceof Uint8ClampedArray?t[e]=Math.floor(dh(t[e]/255)*255):t[e]=dh(t[e]);return{data:t,width:e.width,height:e.height}}return Sm(`ImageUtils.sRGBToLinear(): Unsupported image type. No color space conversion applied.`),e}},hh=0,gh=class{constructor(e=null){this.isTextureSource=!0,Object.defineProperty(this,"id",{value:hh++}),this.uuid=Mm(),this.data=e,this.dataReady=!0,this.version=0}getSize(e){let t=this.data;return typeof HTMLVideoElement<`u`&&t instanceof HTMLVideoElement?e.set(t.videoWidth,t.videoHeight,0):typeof VideoFrame<`u`&&t instanceof VideoFrame?e.set(t.displayWidth,t.displayHeight,0):t===null?e.set(0,0,0):e.set(t.width||0,t.height||0,t.depth||0),e}set needsUpdate(e){e===!0&&this.version++}toJSON(e){let t=e===void 0||typeof e==`string`;if(!t&&e.images[this.uuid]!==void 0)return e.images[this.uuid];let n={uuid:this.uuid,url:``},r=this.data;if(r!==null){let e;if(Array.isArray(r)){e=[];for(let t=0,n=r.length;t<n;t++)r[t].isDataTexture?e.push(_h(r[t].image)):e.push(_h(r[t]))}else e=_h(r);n.url=e}return t||(e.images[this.uuid]=n),n}};function _h(e){return typeof HTMLImageElement<`u`&&e instanceof HTMLImageElement||typeof HTMLCanvasElement<`u`&&e instanceof HTMLCanvasElement||typeof ImageBitmap<`u`&&e instanceof ImageBitmap?mh.getDataURL(e):e.data?{data:Array.from(e.data),width:e.width,height:e.height,type:e.data.constructor.name}:(Sm(`Texture: Unable to serialize Texture.`),{})}var vh=0,yh=new Q,bh=class e extends Dm{constructor(t=e.DEFAULT_IMAGE,n=e.DEFAULT_MAPPING,r=Vf,i=Vf,a=Kf,o=Jf,s=up,c=Yf,l=e.DEFAULT_ANISOTROPY,u=``){super(),this.isTexture=!0,Object.defineProperty(this,"id",{value:vh++}),this.uuid=Mm(),this.name=``,this.source=new gh(t),this.mipmaps=[],this.mapping=n,this.channel=0,this.wrapS=r,this.wrapT=i,this.magFilter=a,this.minFilter=o,this.anisotropy=l,this.format=s,this.internalFormat=null,this.type=c,this.offset=new Z(0,0),this.repeat=new Z(1,1),this.center=new Z(0,0),this.rotation=0,this.matrixAutoUpdate=!0,this.matrix=new ah,this.generateMipmaps=!0,this.mipmapsAutoUpdate=!0,this.premultiplyAlpha=!1,this.flipY=!0,this.unpackAlignment=4,this.colorSpace=u,this.userData={},this.updateRanges=[],this.version=0,this.onUpdate=null,this.renderTarget=null,this.isRenderTargetTexture=!1,this.isArrayTexture=!!(t&&t.depth&&t.depth>1),this.pmremVersion=0,this.isPMREMTexture=!1,this.normalized=!1}get width(){return this.source.getSize(yh).x}get height(){return this.source.getSize(yh).y}get depth(){return this.source.getSize(yh).z}get image(){return this.source.data}set image(e){this.source.data=e}updateMatrix(){this.matrix.setUvTransform(this.offset.x,this.offset.y,this.repeat.x,this.repeat.y,this.rotation,this.center.x,this.center.y)}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}clone(){return new this.constructor().copy(this)}copy(e){return this.name=e.name,this.source=e.source,this.mipmaps=e.mipmaps.slice(0),this.mapping=e.mapping,this.channel=e.channel,this.wrapS=e.wrapS,this.wrapT=e.wrapT,this.magFilter=e.magFilter,this.minFilter=e.minFilter,this.anisotropy=e.anisotropy,this.format=e.format,this.internalFormat=e.internalFormat,this.type=e.type,this.normalized=e.normalized,this.offset.copy(e.offset),this.repeat.copy(e.repeat),this.center.copy(e.center),this.rotation=e.rotation,this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrix.copy(e.matrix),this.generateMipmaps=e.generateMipmaps,this.mipmapsAutoUpdate=e.mipmapsAutoUpdate,this.premultiplyAlpha=e.premultiplyAlpha,this.flipY=e.flipY,this.unpackAlignment=e.unpackAlignment,this.colorSpace=e.colorSpace,this.renderTarget=e.renderTarget,this.isRenderTargetTexture=e.isRenderTargetTexture,this.isPMREMTexture=e.isPMREMTexture,this.isArrayTexture=e.isArrayTexture,this.userData=JSON.parse(JSON.stringify(e.userData)),this.needsUpdate=!0,this}setValues(e){for(let t in e){let n=e[t];if(n===void 0){Sm(`Texture.setValues(): parameter '${t}' has value of undefined.`);continue}let r=this[t];r===void 0?Sm(`Texture.setValues(): property '${t}' does not exist.`):r&&n&&r.isVector2&&n.isVector2||r&&n&&r.isVector3&&n.isVector3||r&&n&&r.isMatrix3&&n.isMatrix3?r.copy(n):this[t]=n}}toJSON(e){let t=e===void 0||typeof e==`string`;if(!t&&e.textures[this.uuid]!==void 0)return e.textures[this.uuid];let n={metadata:{version:4.7,type:`Texture`,generator:`Texture.toJSON`},uuid:this.uuid,name:this.name,image:this.source.toJSON(e).uuid,mapping:this.mapping,channel:this.channel,repeat:[this.repeat.x,this.repeat.y],offset:[this.offset.x,this.offset.y],center:[this.center.x,this.center.y],rotation:this.rotation,wrap:[this.wrapS,this.wrapT],format:this.format,internalFormat:this.internalFormat,type:this.type,normalized:this.normalized,colorSpace:this.colorSpace,minFilter:this.minFilter,magFilter:this.magFilter,anisotropy:this.anisotropy,flipY:this.flipY,generateMipmaps:this.generateMipmaps,mipmapsAutoUpdate:this.mipmapsAutoUpdate,premultiplyAlpha:this.premultiplyAlpha,unpackAlignment:this.unpackAlignment};return Object.keys(this.userData).length>0&&(n.userData=this.userData),t||(e.textures[this.uuid]=n),n}dispose(){this.dispatchEvent({type:`dispose`})}transformUv(e){if(this.mapping!==300)return e;if(e.applyMatrix3(this.matrix),e.x<0||e.x>1)switch(this.wrapS){case Bf:e.x-=Math.floor(e.x);break;case Vf:e.x=e.x<0?0:1;break;case Hf:Math.abs(Math.floor(e.x)%2)===1?e.x=Math.ceil(e.x)-e.x:e.x-=Math.floor(e.x)}if(e.y<0||e.y>1)switch(this.wrapT){case Bf:e.y-=Math.floor(e.y);break;case Vf:e.y=e.y<0?0:1;break;case Hf:Math.abs(Math.floor(e.y)%2)===1?e.y=Math.ceil(e.y)-e.y:e.y-=Math.floor(e.y)}return this.flipY&&(e.y=1-e.y),e}set needsUpdate(e){e===!0&&(this.version++,this.source.needsUpdate=!0)}set needsPMREMUpdate(e){e===!0&&this.pmremVersion++}};bh.DEFAULT_IMAGE=null,bh.DEFAULT_MAPPING=300,bh.DEFAULT_ANISOTROPY=1;var xh=class{static{this.prototype.isVector4=!0}constructor(e=0,t=0,n=0,r=1){this.x=e,this.y=t,this.z=n,this.w=r}get width(){return this.z}set width(e){this.z=e}get height(){return this.w}set height(e){this.w=e}set(e,t,n,r){return this.x=e,this.y=t,this.z=n,this.w=r,this}setScalar(e){return this.x=e,this.y=e,this.z=e,this.w=e,this}setX(e){return this.x=e,this}setY(e){return this.y=e,this}setZ(e){return this.z=e,this}setW(e){return this.w=e,this}setComponent(e,t){switch(e){case 0:this.x=t;break;case 1:this.y=t;break;case 2:this.z=t;break;case 3:this.w=t;break;default:throw Error(`THREE.Vector4: index is out of range: `+e)}return this}getComponent(e){switch(e){case 0:return this.x;case 1:return this.y;case 2:return this.z;case 3:return this.w;default:throw Error(`THREE.Vector4: index is out of range: `+e)}}clone(){return new this.constructor(this.x,this.y,this.z,this.w)}copy(e){return this.x=e.x,this.y=e.y,this.z=e.z,this.w=e.w===void 0?1:e.w,this}add(e){return this.x+=e.x,this.y+=e.y,this.z+=e.z,this.w+=e.w,this}addScalar(e){return this.x+=e,this.y+=e,this.z+=e,this.w+=e,this}addVectors(e,t){return this.x=e.x+t.x,this.y=e.y+t.y,this.z=e.z+t.z,this.w=e.w+t.w,this}addScaledVector(e,t){return this.x+=e.x*t,this.y+=e.y*t,this.z+=e.z*t,this.w+=e.w*t,this}sub(e){return this.x-=e.x,this.y-=e.y,this.z-=e.z,this.w-=e.w,this}subScalar(e){return this.x-=e,this.y-=e,this.z-=e,this.w-=e,this}subVectors(e,t){return this.x=e.x-t.x,this.y=e.y-t.y,this.z=e.z-t.z,this.w=e.w-t.w,this}multiply(e){return this.x*=e.x,this.y*=e.y,this.z*=e.z,this.w*=e.w,this}multiplyScalar(e){return this.x*=e,this.y*=e,this.z*=e,this.w*=e,this}applyMatrix4(e){let t=this.x,n=this.y,r=this.z,i=this.w,a=e.elements;return this.x=a[0]*t+a[4]*n+a[8]*r+a[12]*i,this.y=a[1]*t+a[5]*n+a[9]*r+a[13]*i,this.z=a[2]*t+a[6]*n+a[10]*r+a[14]*i,this.w=a[3]*t+a[7]*n+a[11]*r+a[15]*i,this}divide(e){return this.x/=e.x,this.y/=e.y,this.z/=e.z,this.w/=e.w,this}divideScalar(e){return this.multiplyScalar(1/e)}setAxisAngleFromQuaternion(e){this.w=2*Math.acos(e.w);let t=Math.sqrt(1-e.w*e.w);return t<1e-4?(this.x=1,this.y=0,this.z=0):(this.x=e.x/t,this.y=e.y/t,this.z=e.z/t),this}setAxisAngleFromRotationMatrix(e){let t,n,r,i,a=.01,o=.1,s=e.elements,c=s[0],l=s[4],u=s[8],d=s[1],f=s[5],p=s[9],m=s[2],h=s[6],g=s[10];if(Math.abs(l-d)<a&&Math.abs(u-m)<a&&Math.abs(p-h)<a){if(Math.abs(l+d)<o&&Math.abs(u+m)<o&&Math.abs(p+h)<o&&Math.abs(c+f+g-3)<o)return this.set(1,0,0,0),this;t=Math.PI;let e=(c+1)/2,s=(f+1)/2,_=(g+1)/2,v=(l+d)/4,y=(u+m)/4,b=(p+h)/4;return e>s&&e>_?e<a?(n=0,r=.707106781,i=.707106781):(n=Math.sqrt(e),r=v/n,i=y/n):s>_?s<a?(n=.707106781,r=0,i=.707106781):(r=Math.sqrt(s),n=v/r,i=b/r):_<a?(n=.707106781,r=.707106781,i=0):(i=Math.sqrt(_),n=y/i,r=b/i),this.set(n,r,i,t),this}let _=Math.sqrt((h-p)*(h-p)+(u-m)*(u-m)+(d-l)*(d-l));return Math.abs(_)<.001&&(_=1),this.x=(h-p)/_,this.y=(u-m)/_,this.z=(d-l)/_,this.w=Math.acos((c+f+g-1)/2),this}setFromMatrixPosition(e){let t=e.elements;return this.x=t[12],this.y=t[13],this.z=t[14],this.w=t[15],this}min(e){return this.x=Math.min(this.x,e.x),this.y=Math.min(this.y,e.y),this.z=Math.min(this.z,e.z),this.w=Math.min(this.w,e.w),this}max(e){return this.x=Math.max(this.x,e.x),this.y=Math.max(this.y,e.y),this.z=Math.max(this.z,e.z),this.w=Math.max(this.w,e.w),this}clamp(e,t){return this.x=Nm(this.x,e.x,t.x),this.y=Nm(this.y,e.y,t.y),this.z=Nm(this.z,e.z,t.z),this.w=Nm(this.w,e.w,t.w),this}clampScalar(e,t){return this.x=Nm(this.x,e,t),this.y=Nm(this.y,e,t),this.z=Nm(this.z,e,t),this.w=Nm(this.w,e,t),this}clampLength(e,t){let n=this.length();return this.divideScalar(n||1).multiplyScalar(Nm(n,e,t))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this.w=Math.floor(this.w),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this.w=Math.ceil(this.w),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this.w=Math.round(this.w),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this.w=Math.trunc(this.w),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this.w=-this.w,this}dot(e){return this.x*e.x+this.y*e.y+this.z*e.z+this.w*e.w}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)+Math.abs(this.w)}normalize(){return this.divideScalar(this.length()||1)}setLength(e){return this.normalize().multiplyScalar(e)}lerp(e,t){return this.x+=(e.x-this.x)*t,this.y+=(e.y-this.y)*t,this.z+=(e.z-this.z)*t,this.w+=(e.w-this.w)*t,this}lerpVectors(e,t,n){return this.x=e.x+(t.x-e.x)*n,this.y=e.y+(t.y-e.y)*n,this.z=e.z+(t.z-e.z)*n,this.w=e.w+(t.w-e.w)*n,this}equals(e){return e.x===this.x&&e.y===this.y&&e.z===this.z&&e.w===this.w}fromArray(e,t=0){return this.x=e[t],this.y=e[t+1],this.z=e[t+2],this.w=e[t+3],this}toArray(e=[],t=0){return e[t]=this.x,e[t+1]=this.y,e[t+2]=this.z,e[t+3]=this.w,e}fromBufferAttribute(e,t){return this.x=e.getX(t),this.y=e.getY(t),this.z=e.getZ(t),this.w=e.getW(t),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this.w=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z,yield this.w}},Sh=class extends Dm{constructor(e=1,t=1,n={}){super(),n=Object.assign({generateMipmaps:!1,internalFormat:null,minFilter:Kf,depthBuffer:!0,stencilBuffer:!1,resolveColorBuffer:!0,resolveDepthBuffer:!0,resolveStencilBuffer:!0,storeMultisampledColorBuffer:!0,storeMultisampledDepthBuffer:!0,storeMultisampledStencilBuffer:!0,depthTexture:null,samples:0,count:1,depth:1,multiview:!1,useArrayDepthTexture:!1},n),this.isRenderTarget=!0,this.width=e,this.height=t,this.depth=n.depth,this.scissor=new xh(0,0,e,t),this.scissorTest=!1,this.viewport=new xh(0,0,e,t),this.textures=[];let r=n.count;for(let i=0;i<r;i++)this.textures[i]=new bh({width:e,height:t,depth:n.depth}),this.textures[i].isRenderTargetTexture=!0,this.textures[i].renderTarget=this;this._setTextureOptions(n),this.depthBuffer=n.depthBuffer,this.stencilBuffer=n.stencilBuffer,this.resolveColorBuffer=n.resolveColorBuffer,this.resolveDepthBuffer=n.resolveDepthBuffer,this.resolveStencilBuffer=n.resolveStencilBuffer,this.storeMultisampledColorBuffer=n.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=n.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=n.storeMultisampledStencilBuffer,this._depthTexture=null,this.depthTexture=n.depthTexture,this.samples=n.samples,this.multiview=n.multiview,this.useArrayDepthTexture=n.useArrayDepthTexture}_setTextureOptions(e={}){let t={minFilter:Kf,generateMipmaps:!1,flipY:!1,internalFormat:null};e.mapping!==void 0&&(t.mapping=e.mapping),e.wrapS!==void 0&&(t.wrapS=e.wrapS),e.wrapT!==void 0&&(t.wrapT=e.wrapT),e.wrapR!==void 0&&(t.wrapR=e.wrapR),e.magFilter!==void 0&&(t.magFilter=e.magFilter),e.minFilter!==void 0&&(t.minFilter=e.minFilter),e.format!==void 0&&(t.format=e.format),e.type!==void 0&&(t.type=e.type),e.anisotropy!==void 0&&(t.anisotropy=e.anisotropy),e.colorSpace!==void 0&&(t.colorSpace=e.colorSpace),e.flipY!==void 0&&(t.flipY=e.flipY),e.generateMipmaps!==void 0&&(t.generateMipmaps=e.generateMipmaps),e.mipmapsAutoUpdate!==void 0&&(t.mipmapsAutoUpdate=e.mipmapsAutoUpdate),e.internalFormat!==void 0&&(t.internalFormat=e.internalFormat);for(let e=0;e<this.textures.length;e++)this.textures[e].setValues(t)}get texture(){return this.textures[0]}set texture(e){this.textures[0]=e}set depthTexture(e){this._depthTexture!==null&&this._depthTexture.renderTarget===this&&(this._depthTexture.renderTarget=null),e!==null&&e.renderTarget===null&&(e.renderTarget=this),this._depthTexture=e}get depthTexture(){return this._depthTexture}setSize(e,t,n=1){if(this.width!==e||this.height!==t||this.depth!==n){this.width=e,this.height=t,this.depth=n;for(let r=0,i=this.textures.length;r<i;r++)this.textures[r].image.width=e,this.textures[r].image.height=t,this.textures[r].image.depth=n,this.textures[r].isData3DTexture!==!0&&(this.textures[r].isArrayTexture=this.textures[r].image.depth>1);this.dispose()}this.viewport.set(0,0,e,t),this.scissor.set(0,0,e,t)}clone(){return new this.constructor().copy(this)}copy(e){this.width=e.width,this.height=e.height,this.depth=e.depth,this.scissor.copy(e.scissor),this.scissorTest=e.scissorTest,this.viewport.copy(e.viewport),this.textures.length=0;for(let t=0,n=e.textures.length;t<n;t++){this.textures[t]=e.textures[t].clone(),this.textures[t].isRenderTargetTexture=!0,this.textures[t].renderTarget=this;let n=Object.assign({},e.textures[t].image);this.textures[t].source=new gh(n)}if(this.depthBuffer=e.depthBuffer,this.stencilBuffer=e.stencilBuffer,this.resolveColorBuffer=e.resolveColorBuffer,this.resolveDepthBuffer=e.resolveDepthBuffer,this.resolveStencilBuffer=e.resolveStencilBuffer,this.storeMultisampledColorBuffer=e.storeMultisampledColorBuffer,this.storeMultisampledDepthBuffer=e.storeMultisampledDepthBuffer,this.storeMultisampledStencilBuffer=e.storeMultisampledStencilBuffer,e.depthTexture!==null){if(e.depthTexture.renderTarget===e){let t=e.depthTexture.clone();t.renderTarget=null,this.depthTexture=t}else this.depthTexture=e.depthTexture}else this.depthTexture=null;return this.samples=e.samples,this.multiview=e.multiview,this.useArrayDepthTexture=e.useArrayDepthTexture,this}dispose(){this.dispatchEvent({type:`dispose`})}},Ch=class extends Sh{constructor(e=1,t=1,n={}){super(e,t,n),this.isWebGLRenderTarget=!0}},wh=class extends bh{constructor(e=null,t=1,n=1,r=1){super(null),this.isDataArrayTexture=!0,this.image={data:e,width:t,height:n,depth:r},this.magFilter=Uf,this.minFilter=Uf,this.wrapR=Vf,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1,this.layerUpdates=new Set}copy(e){return super.copy(e),this.wrapR=e.wrapR,this}addLayerUpdate(e){this.layerUpdates.add(e)}clearLayerUpdates(){this.layerUpdates.clear()}},Th=class extends bh{constructor(e=null,t=1,n=1,r=1){super(null),this.isData3DTexture=!0,this.image={data:e,width:t,height:n,depth:r},this.magFilter=Uf,this.minFilter=Uf,this.wrapR=Vf,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}copy(e){return super.copy(e),this.wrapR=e.wrapR,this}},Eh=class e{static{this.prototype.isMatrix4=!0}constructor(e,t,n,r,i,a,o,s,c,l,u,d,f,p,m,h){this.elements=[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],e!==void 0&&this.set(e,t,n,r,i,a,o,s,c,l,u,d,f,p,m,h)}set(e,t,n,r,i,a,o,s,c,l,u,d,f,p,m,h){let g=this.elements;return g[0]=e,g[4]=t,g[8]=n,g[12]=r,g[1]=i,g[5]=a,g[9]=o,g[13]=s,g[2]=c,g[6]=l,g[10]=u,g[14]=d,g[3]=f,g[7]=p,g[11]=m,g[15]=h,this}identity(){return this.set(1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1),this}clone(){return new e().fromArray(this.elements)}copy(e){let t=this.elements,n=e.elements;return t[0]=n[0],t[1]=n[1],t[2]=n[2],t[3]=n[3],t[4]=n[4],t[5]=n[5],t[6]=n[6],t[7]=n[7],t[8]=n[8],t[9]=n[9],t[10]=n[10],t[11]=n[11],t[12]=n[12],t[13]=n[13],t[14]=n[14],t[15]=n[15],this}copyPosition(e){let t=this.elements,n=e.elements;return t[12]=n[12],t[13]=n[13],t[14]=n[14],this}setFromMatrix3(e){let t=e.elements;return this.set(t[0],t[3],t[6],0,t[1],t[4],t[7],0,t[2],t[5],t[8],0,0,0,0,1),this}extractBasis(e,t,n){return this.determinantAffine()===0?(e.set(1,0,0),t.set(0,1,0),n.set(0,0,1),this):(e.setFromMatrixColumn(this,0),t.setFromMatrixColumn(this,1),n.setFromMatrixColumn(this,2),this)}makeBasis(e,t,n){return this.set(e.x,t.x,n.x,0,e.y,t.y,n.y,0,e.z,t.z,n.z,0,0,0,0,1),this}extractRotation(e){if(e.determinantAffine()===0)return this.identity();let t=this.elements,n=e.elements,r=1/Dh.setFromMatrixColumn(e,0).length(),i=1/Dh.setFromMatrixColumn(e,1).length(),a=1/Dh.setFromMatrixColumn(e,2).length();return t[0]=n[0]*r,t[1]=n[1]*r,t[2]=n[2]*r,t[3]=0,t[4]=n[4]*i,t[5]=n[5]*i,t[6]=n[6]*i,t[7]=0,t[8]=n[8]*a,t[9]=n[9]*a,t[10]=n[10]*a,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromEuler(e){let t=this.elements,n=e.x,r=e.y,i=e.z,a=Math.cos(n),o=Math.sin(n),s=Math.cos(r),c=Math.sin(r),l=Math.cos(i),u=Math.sin(i);if(e.order===`XYZ`){let e=a*l,n=a*u,r=o*l,i=o*u;t[0]=s*l,t[4]=-s*u,t[8]=c,t[1]=n+r*c,t[5]=e-i*c,t[9]=-o*s,t[2]=i-e*c,t[6]=r+n*c,t[10]=a*s}else if(e.order===`YXZ`){let e=s*l,n=s*u,r=c*l,i=c*u;t[0]=e+i*o,t[4]=r*o-n,t[8]=a*c,t[1]=a*u,t[5]=a*l,t[9]=-o,t[2]=n*o-r,t[6]=i+e*o,t[10]=a*s}else if(e.order===`ZXY`){let e=s*l,n=s*u,r=c*l,i=c*u;t[0]=e-i*o,t[4]=-a*u,t[8]=r+n*o,t[1]=n+r*o,t[5]=a*l,t[9]=i-e*o,t[2]=-a*c,t[6]=o,t[10]=a*s}else if(e.order===`ZYX`){let e=a*l,n=a*u,r=o*l,i=o*u;t[0]=s*l,t[4]=r*c-n,t[8]=e*c+i,t[1]=s*u,t[5]=i*c+e,t[9]=n*c-r,t[2]=-c,t[6]=o*s,t[10]=a*s}else if(e.order===`YZX`){let e=a*s,n=a*c,r=o*s,i=o*c;t[0]=s*l,t[4]=i-e*u,t[8]=r*u+n,t[1]=u,t[5]=a*l,t[9]=-o*l,t[2]=-c*l,t[6]=n*u+r,t[10]=e-i*u}else if(e.order===`XZY`){let e=a*s,n=a*c,r=o*s,i=o*c;t[0]=s*l,t[4]=-u,t[8]=c*l,t[1]=e*u+i,t[5]=a*l,t[9]=n*u-r,t[2]=r*u-n,t[6]=o*l,t[10]=i*u+e}return t[3]=0,t[7]=0,t[11]=0,t[12]=0,t[13]=0,t[14]=0,t[15]=1,this}makeRotationFromQuaternion(e){return this.compose(kh,e,Ah)}lookAt(e,t,n){let r=this.elements;return Nh.subVectors(e,t),Nh.lengthSq()===0&&(Nh.z=1),Nh.normalize(),jh.crossVectors(n,Nh),jh.lengthSq()===0&&(Math.abs(n.z)===1?Nh.x+=1e-4:Nh.z+=1e-4,Nh.normalize(),jh.crossVectors(n,Nh)),jh.normalize(),Mh.crossVectors(Nh,jh),r[0]=jh.x,r[4]=Mh.x,r[8]=Nh.x,r[1]=jh.y,r[5]=Mh.y,r[9]=Nh.y,r[2]=jh.z,r[6]=Mh.z,r[10]=Nh.z,this}multiply(e){return this.multiplyMatrices(this,e)}premultiply(e){return this.multiplyMatrices(e,this)}multiplyMatrices(e,t){let n=e.elements,r=t.elements,i=this.elements,a=n[0],o=n[4],s=n[8],c=n[12],l=n[1],u=n[5],d=n[9],f=n[13],p=n[2],m=n[6],h=n[10],g=n[14],_=n[3],v=n[7],y=n[11],b=n[15],x=r[0],S=r[4],C=r[8],w=r[12],T=r[1],E=r[5],D=r[9],O=r[13],ee=r[2],k=r[6],te=r[10],ne=r[14],re=r[3],ie=r[7],ae=r[11],oe=r[15];return i[0]=a*x+o*T+s*ee+c*re,i[4]=a*S+o*E+s*k+c*ie,i[8]=a*C+o*D+s*te+c*ae,i[12]=a*w+o*O+s*ne+c*oe,i[1]=l*x+u*T+d*ee+f*re,i[5]=l*S+u*E+d*k+f*ie,i[9]=l*C+u*D+d*te+f*ae,i[13]=l*w+u*O+d*ne+f*oe,i[2]=p*x+m*T+h*ee+g*re,i[6]=p*S+m*E+h*k+g*ie,i[10]=p*C+m*D+h*te+g*ae,i[14]=p*w+m*O+h*ne+g*oe,i[3]=_*x+v*T+y*ee+b*re,i[7]=_*S+v*E+y*k+b*ie,i[11]=_*C+v*D+y*te+b*ae,i[15]=_*w+v*O+y*ne+b*oe,this}multiplyScalar(e){let t=this.elements;return t[0]*=e,t[4]*=e,t[8]*=e,t[12]*=e,t[1]*=e,t[5]*=e,t[9]*=e,t[13]*=e,t[2]*=e,t[6]*=e,t[10]*=e,t[14]*=e,t[3]*=e,t[7]*=e,t[11]*=e,t[15]*=e,this}determinant(){let e=this.elements,t=e[0],n=e[4],r=e[8],i=e[12],a=e[1],o=e[5],s=e[9],c=e[13],l=e[2],u=e[6],d=e[10],f=e[14],p=e[3],m=e[7],h=e[11],g=e[15],_=s*f-c*d,v=o*f-c*u,y=o*d-s*u,b=a*f-c*l,x=a*d-s*l,S=a*u-o*l;return t*(m*_-h*v+g*y)-n*(p*_-h*b+g*x)+r*(p*v-m*b+g*S)-i*(p*y-m*x+h*S)}determinantAffine(){let e=this.elements,t=e[0],n=e[4],r=e[8],i=e[1],a=e[5],o=e[9],s=e[2],c=e[6],l=e[10];return t*(a*l-o*c)-n*(i*l-o*s)+r*(i*c-a*s)}transpose(){let e=this.elements,t;return t=e[1],e[1]=e[4],e[4]=t,t=e[2],e[2]=e[8],e[8]=t,t=e[6],e[6]=e[9],e[9]=t,t=e[3],e[3]=e[12],e[12]=t,t=e[7],e[7]=e[13],e[13]=t,t=e[11],e[11]=e[14],e[14]=t,this}setPosition(e,t,n){let r=this.elements;return e.isVector3?(r[12]=e.x,r[13]=e.y,r[14]=e.z):(r[12]=e,r[13]=t,r[14]=n),this}invert(){let e=this.elements,t=e[0],n=e[1],r=e[2],i=e[3],a=e[4],o=e[5],s=e[6],c=e[7],l=e[8],u=e[9],d=e[10],f=e[11],p=e[12],m=e[13],h=e[14],g=e[15],_=t*o-n*a,v=t*s-r*a,y=t*c-i*a,b=n*s-r*o,x=n*c-i*o,S=r*c-i*s,C=l*m-u*p,w=l*h-d*p,T=l*g-f*p,E=u*h-d*m,D=u*g-f*m,O=d*g-f*h,ee=_*O-v*D+y*E+b*T-x*w+S*C;if(ee===0)return this.set(0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0);let k=1/ee;return e[0]=(o*O-s*D+c*E)*k,e[1]=(r*D-n*O-i*E)*k,e[2]=(m*S-h*x+g*b)*k,e[3]=(d*x-u*S-f*b)*k,e[4]=(s*T-a*O-c*w)*k,e[5]=(t*O-r*T+i*w)*k,e[6]=(h*y-p*S-g*v)*k,e[7]=(l*S-d*y+f*v)*k,e[8]=(a*D-o*T+c*C)*k,e[9]=(n*T-t*D-i*C)*k,e[10]=(p*x-m*y+g*_)*k,e[11]=(u*y-l*x-f*_)*k,e[12]=(o*w-a*E-s*C)*k,e[13]=(t*E-n*w+r*C)*k,e[14]=(m*v-p*b-h*_)*k,e[15]=(l*b-u*v+d*_)*k,this}scale(e){let t=this.elements,n=e.x,r=e.y,i=e.z;return t[0]*=n,t[4]*=r,t[8]*=i,t[1]*=n,t[5]*=r,t[9]*=i,t[2]*=n,t[6]*=r,t[10]*=i,t[3]*=n,t[7]*=r,t[11]*=i,this}getMaxScaleOnAxis(){let e=this.elements,t=e[0]*e[0]+e[1]*e[1]+e[2]*e[2],n=e[4]*e[4]+e[5]*e[5]+e[6]*e[6],r=e[8]*e[8]+e[9]*e[9]+e[10]*e[10];return Math.sqrt(Math.max(t,n,r))}makeTranslation(e,t,n){return e.isVector3?this.set(1,0,0,e.x,0,1,0,e.y,0,0,1,e.z,0,0,0,1):this.set(1,0,0,e,0,1,0,t,0,0,1,n,0,0,0,1),this}makeRotationX(e){let t=Math.cos(e),n=Math.sin(e);return this.set(1,0,0,0,0,t,-n,0,0,n,t,0,0,0,0,1),this}makeRotationY(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,0,n,0,0,1,0,0,-n,0,t,0,0,0,0,1),this}makeRotationZ(e){let t=Math.cos(e),n=Math.sin(e);return this.set(t,-n,0,0,n,t,0,0,0,0,1,0,0,0,0,1),this}makeRotationAxis(e,t){let n=Math.cos(t),r=Math.sin(t),i=1-n,a=e.x,o=e.y,s=e.z,c=i*a,l=i*o;return this.set(c*a+n,c*o-r*s,c*s+r*o,0,c*o+r*s,l*o+n,l*s-r*a,0,c*s-r*o,l*s+r*a,i*s*s+n,0,0,0,0,1),this}makeScale(e,t,n){return this.set(e,0,0,0,0,t,0,0,0,0,n,0,0,0,0,1),this}makeShear(e,t,n,r,i,a){return this.set(1,n,i,0,e,1,a,0,t,r,1,0,0,0,0,1),this}compose(e,t,n){let r=this.elements,i=t._x,a=t._y,o=t._z,s=t._w,c=i+i,l=a+a,u=o+o,d=i*c,f=i*l,p=i*u,m=a*l,h=a*u,g=o*u,_=s*c,v=s*l,y=s*u,b=n.x,x=n.y,S=n.z;return r[0]=(1-(m+g))*b,r[1]=(f+y)*b,r[2]=(p-v)*b,r[3]=0,r[4]=(f-y)*x,r[5]=(1-(d+g))*x,r[6]=(h+_)*x,r[7]=0,r[8]=(p+v)*S,r[9]=(h-_)*S,r[10]=(1-(d+m))*S,r[11]=0,r[12]=e.x,r[13]=e.y,r[14]=e.z,r[15]=1,this}decompose(e,t,n){let r=this.elements;e.x=r[12],e.y=r[13],e.z=r[14];let i=this.determinantAffine();if(i===0)return n.set(1,1,1),t.identity(),this;let a=Dh.set(r[0],r[1],r[2]).length(),o=Dh.set(r[4],r[5],r[6]).length(),s=Dh.set(r[8],r[9],r[10]).length();i<0&&(a=-a),Oh.copy(this);let c=1/a,l=1/o,u=1/s;return Oh.elements[0]*=c,Oh.elements[1]*=c,Oh.elements[2]*=c,Oh.elements[4]*=l,Oh.elements[5]*=l,Oh.elements[6]*=l,Oh.elements[8]*=u,Oh.elements[9]*=u,Oh.elements[10]*=u,t.setFromRotationMatrix(Oh),n.x=a,n.y=o,n.z=s,this}makePerspective(e,t,n,r,i,a,o=mm,s=!1){let c=this.elements,l=2*i/(t-e),u=2*i/(n-r),d=(t+e)/(t-e),f=(n+r)/(n-r),p,m;if(s)p=i/(a-i),m=a*i/(a-i);else if(o===2e3)p=-(a+i)/(a-i),m=-2*a*i/(a-i);else if(o===2001)p=-a/(a-i),m=-a*i/(a-i);else throw Error(`THREE.Matrix4.makePerspective(): Invalid coordinate system: `+o);return c[0]=l,c[4]=0,c[8]=d,c[12]=0,c[1]=0,c[5]=u,c[9]=f,c[13]=0,c[2]=0,c[6]=0,c[10]=p,c[14]=m,c[3]=0,c[7]=0,c[11]=-1,c[15]=0,this}makeOrthographic(e,t,n,r,i,a,o=mm,s=!1){let c=this.elements,l=2/(t-e),u=2/(n-r),d=-(t+e)/(t-e),f=-(n+r)/(n-r),p,m;if(s)p=1/(a-i),m=a/(a-i);else if(o===2e3)p=-2/(a-i),m=-(a+i)/(a-i);else if(o===2001)p=-1/(a-i),m=-i/(a-i);else throw Error(`THREE.Matrix4.makeOrthographic(): Invalid coordinate system: `+o);return c[0]=l,c[4]=0,c[8]=0,c[12]=d,c[1]=0,c[5]=u,c[9]=0,c[13]=f,c[2]=0,c[6]=0,c[10]=p,c[14]=m,c[3]=0,c[7]=0,c[11]=0,c[15]=1,this}equals(e){let t=this.elements,n=e.elements;for(let e=0;e<16;e++)if(t[e]!==n[e])return!1;return!0}fromArray(e,t=0){for(let n=0;n<16;n++)this.elements[n]=e[n+t];return this}toArray(e=[],t=0){let n=this.elements;return e[t]=n[0],e[t+1]=n[1],e[t+2]=n[2],e[t+3]=n[3],e[t+4]=n[4],e[t+5]=n[5],e[t+6]=n[6],e[t+7]=n[7],e[t+8]=n[8],e[t+9]=n[9],e[t+10]=n[10],e[t+11]=n[11],e[t+12]=n[12],e[t+13]=n[13],e[t+14]=n[14],e[t+15]=n[15],e}},Dh=new Q,Oh=new Eh,kh=new Q(0,0,0),Ah=new Q(1,1,1),jh=new Q,Mh=new Q,Nh=new Q,Ph=new Eh,Fh=new nh,Ih=class e{constructor(t=0,n=0,r=0,i=e.DEFAULT_ORDER){this.isEuler=!0,this._x=t,this._y=n,this._z=r,this._order=i}get x(){return this._x}set x(e){this._x=e,this._onChangeCallback()}get y(){return this._y}set y(e){this._y=e,this._onChangeCallback()}get z(){return this._z}set z(e){this._z=e,this._onChangeCallback()}get order(){return this._order}set order(e){this._order=e,this._onChangeCallback()}set(e,t,n,r=this._order){return this._x=e,this._y=t,this._z=n,this._order=r,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._order)}copy(e){return this._x=e._x,this._y=e._y,this._z=e._z,this._order=e._order,this._onChangeCallback(),this}setFromRotationMatrix(e,t=this._order,n=!0){let r=e.elements,i=r[0],a=r[4],o=r[8],s=r[1],c=r[5],l=r[9],u=r[2],d=r[6],f=r[10];switch(t){case`XYZ`:this._y=Math.asin(Nm(o,-1,1)),Math.abs(o)<.9999999?(this._x=Math.atan2(-l,f),this._z=Math.atan2(-a,i)):(this._x=Math.atan2(d,c),this._z=0);break;case`YXZ`:this._x=Math.asin(-Nm(l,-1,1)),Math.abs(l)<.9999999?(this._y=Math.atan2(o,f),this._z=Math.atan2(s,c)):(this._y=Math.atan2(-u,i),this._z=0);break;case`ZXY`:this._x=Math.asin(Nm(d,-1,1)),Math.abs(d)<.9999999?(this._y=Math.atan2(-u,f),this._z=Math.atan2(-a,c)):(this._y=0,this._z=Math.atan2(s,i));break;case`ZYX`:this._y=Math.asin(-Nm(u,-1,1)),Math.abs(u)<.9999999?(this._x=Math.atan2(d,f),this._z=Math.atan2(s,i)):(this._x=0,this._z=Math.atan2(-a,c));break;case`YZX`:this._z=Math.asin(Nm(s,-1,1)),Math.abs(s)<.9999999?(this._x=Math.atan2(-l,c),this._y=Math.atan2(-u,i)):(this._x=0,this._y=Math.atan2(o,f));break;case`XZY`:this._z=Math.asin(-Nm(a,-1,1)),Math.abs(a)<.9999999?(this._x=Math.atan2(d,c),this._y=Math.atan2(o,i)):(this._x=Math.atan2(-l,f),this._y=0);break;default:Sm(`Euler: .setFromRotationMatrix() encountered an unknown order: `+t)}return this._order=t,n===!0&&this._onChangeCallback(),this}setFromQuaternion(e,t,n){return Ph.makeRotationFromQuaternion(e),this.setFromRotationMatrix(Ph,t,n)}setFromVector3(e,t=this._order){return this.set(e.x,e.y,e.z,t)}reorder(e){return Fh.setFromEuler(this),this.setFromQuaternion(Fh,e)}equals(e){return e._x===this._x&&e._y===this._y&&e._z===this._z&&e._order===this._order}fromArray(e){return this._x=e[0],this._y=e[1],this._z=e[2],e[3]!==void 0&&(this._order=e[3]),this._onChangeCallback(),this}toArray(e=[],t=0){return e[t]=this._x,e[t+1]=this._y,e[t+2]=this._z,e[t+3]=this._order,e}_onChange(e){return this._onChangeCallback=e,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._order}};Ih.DEFAULT_ORDER=`XYZ`;var Lh=class{constructor(){this.mask=1}set(e){this.mask=1<<e>>>0}enable(e){this.mask|=1<<e}enableAll(){this.mask=-1}toggle(e){this.mask^=1<<e}disable(e){this.mask&=~(1<<e)}disableAll(){this.mask=0}test(e){return(this.mask&e.mask)!==0}isEnabled(e){return!!(this.mask&1<<e)}},Rh=0,zh=new Q,Bh=new nh,Vh=new Eh,Hh=new Q,Uh=new Q,Wh=new Q,Gh=new nh,Kh=new Q(1,0,0),qh=new Q(0,1,0),Jh=new Q(0,0,1),Yh={type:`added`},Xh={type:`removed`},Zh={type:`childadded`,child:null},Qh={type:`childremoved`,child:null},$h=class e extends Dm{constructor(){super(),this.isObject3D=!0,Object.defineProperty(this,"id",{value:Rh++}),this.uuid=Mm(),this.name=``,this.type=`Object3D`,this.parent=null,this.children=[],this.up=e.DEFAULT_UP.clone();let t=new Q,n=new Ih,r=new nh,i=new Q(1,1,1);function a(){r.setFromEuler(n,!1)}function o(){n.setFromQuaternion(r,void 0,!1)}n._onChange(a),r._onChange(o),Object.defineProperties(this,{position:{configurable:!0,enumerable:!0,value:t},rotation:{configurable:!0,enumerable:!0,value:n},quaternion:{configurable:!0,enumerable:!0,value:r},scale:{configurable:!0,enumerable:!0,value:i},modelViewMatrix:{value:new Eh},normalMatrix:{value:new ah}}),this.matrix=new Eh,this.matrixWorld=new Eh,this.matrixAutoUpdate=e.DEFAULT_MATRIX_AUTO_UPDATE,this.matrixWorldAutoUpdate=e.DEFAULT_MATRIX_WORLD_AUTO_UPDATE,this.matrixWorldNeedsUpdate=!1,this.layers=new Lh,this.visible=!0,this.castShadow=!1,this.receiveShadow=!1,this.frustumCulled=!0,this.renderOrder=0,this.animations=[],this.customDepthMaterial=void 0,this.customDistanceMaterial=void 0,this.static=!1,this.userData={},this.pivot=null}onBeforeShadow(){}onAfterShadow(){}onBeforeRender(){}onAfterRender(){}applyMatrix4(e){this.matrixAutoUpdate&&this.updateMatrix(),this.matrix.premultiply(e),this.matrix.decompose(this.position,this.quaternion,this.scale),this.pivot!==null&&this.position.copy(this.pivot).applyMatrix4(this.matrix).sub(this.pivot)}applyQuaternion(e){return this.quaternion.premultiply(e),this}setRotationFromAxisAngle(e,t){this.quaternion.setFromAxisAngle(e,t)}setRotationFromEuler(e){this.quaternion.setFromEuler(e,!0)}setRotationFromMatrix(e){this.quaternion.setFromRotationMatrix(e)}setRotationFromQuaternion(e){this.quaternion.copy(e)}rotateOnAxis(e,t){return Bh.setFromAxisAngle(e,t),this.quaternion.multiply(Bh),this}rotateOnWorldAxis(e,t){return Bh.setFromAxisAngle(e,t),this.quaternion.premultiply(Bh),this}rotateX(e){return this.rotateOnAxis(Kh,e)}rotateY(e){return this.rotateOnAxis(qh,e)}rotateZ(e){return this.rotateOnAxis(Jh,e)}translateOnAxis(e,t){return zh.copy(e).applyQuaternion(this.quaternion),this.position.add(zh.multiplyScalar(t)),this}translateX(e){return this.translateOnAxis(Kh,e)}translateY(e){return this.translateOnAxis(qh,e)}translateZ(e){return this.translateOnAxis(Jh,e)}localToWorld(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(this.matrixWorld)}worldToLocal(e){return this.updateWorldMatrix(!0,!1),e.applyMatrix4(Vh.copy(this.matrixWorld).invert())}lookAt(e,t,n){e.isVector3?Hh.copy(e):Hh.set(e,t,n);let r=this.parent;this.updateWorldMatrix(!0,!1),Uh.setFromMatrixPosition(this.matrixWorld),this.isCamera||this.isLight?Vh.lookAt(Uh,Hh,this.up):Vh.lookAt(Hh,Uh,this.up),this.quaternion.setFromRotationMatrix(Vh),r&&(Vh.extractRotation(r.matrixWorld),Bh.setFromRotationMatrix(Vh),this.quaternion.premultiply(Bh.invert()))}add(e){if(arguments.length>1){for(let e=0;e<arguments.length;e++)this.add(arguments[e]);return this}return e===this?(Cm(`Object3D.add: object can't be added as a child of itself.`,e),this):(e&&e.isObject3D?(e.removeFromParent(),e.parent=this,this.children.push(e),e.dispatchEvent(Yh),Zh.child=e,this.dispatchEvent(Zh),Zh.child=null):Cm(`Object3D.add: object not an instance of THREE.Object3D.`,e),this)}remove(e){if(arguments.length>1){for(let e=0;e<arguments.length;e++)this.remove(arguments[e]);return this}let t=this.children.indexOf(e);return t!==-1&&(e.parent=null,this.children.splice(t,1),e.dispatchEvent(Xh),Qh.child=e,this.dispatchEvent(Qh),Qh.child=null),this}removeFromParent(){let e=this.parent;return e!==null&&e.remove(this),this}clear(){return this.remove(...this.children)}attach(e){return this.updateWorldMatrix(!0,!1),Vh.copy(this.matrixWorld).invert(),e.parent!==null&&(e.parent.updateWorldMatrix(!0,!1),Vh.multiply(e.parent.matrixWorld)),e.applyMatrix4(Vh),e.removeFromParent(),e.parent=this,this.children.push(e),e.updateWorldMatrix(!1,!0),e.dispatchEvent(Yh),Zh.child=e,this.dispatchEvent(Zh),Zh.child=null,this}getObjectById(e){return this.getObjectByProperty(`id`,e)}getObjectByName(e){return this.getObjectByProperty(`name`,e)}getObjectByProperty(e,t){if(this[e]===t)return this;for(let n=0,r=this.children.length;n<r;n++){let r=this.children[n].getObjectByProperty(e,t);if(r!==void 0)return r}}getObjectsByProperty(e,t,n=[]){this[e]===t&&n.push(this);let r=this.children;for(let i=0,a=r.length;i<a;i++)r[i].getObjectsByProperty(e,t,n);return n}getWorldPosition(e){return this.updateWorldMatrix(!0,!1),e.setFromMatrixPosition(this.matrixWorld)}getWorldQuaternion(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(Uh,e,Wh),e}getWorldScale(e){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(Uh,Gh,e),e}getWorldDirection(e){this.updateWorldMatrix(!0,!1);let t=this.matrixWorld.elements;return e.set(t[8],t[9],t[10]).normalize()}raycast(){}intersectsFrustum(){return!0}traverse(e){e(this);let t=this.children;for(let n=0,r=t.length;n<r;n++)t[n].traverse(e)}traverseVisible(e){if(this.visible===!1)return;e(this);let t=this.children;for(let n=0,r=t.length;n<r;n++)t[n].traverseVisible(e)}traverseAncestors(e){let t=this.parent;t!==null&&(e(t),t.traverseAncestors(e))}updateMatrix(){this.matrix.compose(this.position,this.quaternion,this.scale);let e=this.pivot;if(e!==null){let t=e.x,n=e.y,r=e.z,i=this.matrix.elements;i[12]+=t-i[0]*t-i[4]*n-i[8]*r,i[13]+=n-i[1]*t-i[5]*n-i[9]*r,i[14]+=r-i[2]*t-i[6]*n-i[10]*r}this.matrixWorldNeedsUpdate=!0}updateMatrixWorld(e){this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||e)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,e=!0);let t=this.children;for(let n=0,r=t.length;n<r;n++)t[n].updateMatrixWorld(e)}updateWorldMatrix(e,t,n=!1){let r=this.parent;if(e===!0&&r!==null&&r.updateWorldMatrix(!0,!1),this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||n)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,n=!0),t===!0){let e=this.children;for(let t=0,r=e.length;t<r;t++)e[t].updateWorldMatrix(!1,!0,n)}}toJSON(e){let t=e===void 0||typeof e==`string`,n={};t&&(e={geometries:{},materials:{},textures:{},images:{},shapes:{},skeletons:{},animations:{},nodes:{}},n.metadata={version:4.7,type:`Object`,generator:`Object3D.toJSON`});let r={};r.uuid=this.uuid,r.type=this.type,r.name=this.name,r.castShadow=this.castShadow,r.receiveShadow=this.receiveShadow,r.visible=this.visible,r.frustumCulled=this.frustumCulled,r.renderOrder=this.renderOrder,r.static=this.static,r.matrixAutoUpdate=this.matrixAutoUpdate,Object.keys(this.userData).length>0&&(r.userData=this.userData),r.layers=this.layers.mask,r.matrix=this.matrix.toArray(),r.up=this.up.toArray(),this.pivot!==null&&(r.pivot=this.pivot.toArray()),this.morphTargetDictionary!==void 0&&(r.morphTargetDictionary=Object.assign({},this.morphTargetDictionary)),this.morphTargetInfluences!==void 0&&(r.morphTargetInfluences=this.morphTargetInfluences.slice()),this.isInstancedMesh&&(r.type=`InstancedMesh`,r.count=this.count,r.instanceMatrix=this.instanceMatrix.toJSON(),this.instanceColor!==null&&(r.instanceColor=this.instanceColor.toJSON())),this.isBatchedMesh&&(r.type=`BatchedMesh`,r.perObjectFrustumCulled=this.perObjectFrustumCulled,r.sortObjects=this.sortObjects,r.drawRanges=this._drawRanges,r.reservedRanges=this._reservedRanges,r.geometryInfo=this._geometryInfo.map(e=>({...e,boundingBox:e.boundingBox?e.boundingBox.toJSON():void 0,boundingSphere:e.boundingSphere?e.boundingSphere.toJSON():void 0})),r.instanceInfo=this._instanceInfo.map(e=>({...e})),r.availableInstanceIds=this._availableInstanceIds.slice(),r.availableGeometryIds=this._availableGeometryIds.slice(),r.nextIndexStart=this._nextIndexStart,r.nextVertexStart=this._nextVertexStart,r.geometryCount=this._geometryCount,r.maxInstanceCount=this._maxInstanceCount,r.maxVertexCount=this._maxVertexCount,r.maxIndexCount=this._maxIndexCount,r.geometryInitialized=this._geometryInitialized,r.matricesTexture=this._matricesTexture.toJSON(e),r.indirectTexture=this._indirectTexture.toJSON(e),this._colorsTexture!==null&&(r.colorsTexture=this._colorsTexture.toJSON(e)),this.boundingSphere!==null&&(r.boundingSphere=this.boundingSphere.toJSON()),this.boundingBox!==null&&(r.boundingBox=this.boundingBox.toJSON()));function i(t,n){return t[n.uuid]===void 0&&(t[n.uuid]=n.toJSON(e)),n.uuid}if(this.isScene)this.background&&(this.background.isColor?r.background=this.background.toJSON():this.background.isTexture&&(r.background=this.background.toJSON(e).uuid)),this.environment&&this.environment.isTexture&&this.environment.isRenderTargetTexture!==!0&&(r.environment=this.environment.toJSON(e).uuid);else if(this.isMesh||this.isLine||this.isPoints){r.geometry=i(e.geometries,this.geometry);let t=this.geometry.parameters;if(t!==void 0&&t.shapes!==void 0){let n=t.shapes;if(Array.isArray(n))for(let t=0,r=n.length;t<r;t++){let r=n[t];i(e.shapes,r)}else i(e.shapes,n)}}if(this.isSkinnedMesh&&(r.bindMode=this.bindMode,r.bindMatrix=this.bindMatrix.toArray(),this.skeleton!==void 0&&(i(e.skeletons,this.skeleton),r.skeleton=this.skeleton.uuid)),this.material!==void 0){if(Array.isArray(this.material)){let t=[];for(let n=0,r=this.material.length;n<r;n++)t.push(i(e.materials,this.material[n]));r.material=t}else r.material=i(e.materials,this.material)}if(this.children.length>0){r.children=[];for(let t=0;t<this.children.length;t++)r.children.push(this.children[t].toJSON(e).object)}if(this.animations.length>0){r.animations=[];for(let t=0;t<this.animations.length;t++){let n=this.animations[t];r.animations.push(i(e.animations,n))}}if(t){let t=a(e.geometries),r=a(e.materials),i=a(e.textures),o=a(e.images),s=a(e.shapes),c=a(e.skeletons),l=a(e.animations),u=a(e.nodes);t.length>0&&(n.geometries=t),r.length>0&&(n.materials=r),i.length>0&&(n.textures=i),o.length>0&&(n.images=o),s.length>0&&(n.shapes=s),c.length>0&&(n.skeletons=c),l.length>0&&(n.animations=l),u.length>0&&(n.nodes=u)}return n.object=r,n;function a(e){let t=[];for(let n in e){let r=e[n];delete r.metadata,t.push(r)}return t}}clone(e){return new this.constructor().copy(this,e)}copy(e,t=!0){if(this.name=e.name,this.up.copy(e.up),this.position.copy(e.position),this.rotation.order=e.rotation.order,this.quaternion.copy(e.quaternion),this.scale.copy(e.scale),this.pivot=e.pivot===null?null:e.pivot.clone(),this.matrix.copy(e.matrix),this.matrixWorld.copy(e.matrixWorld),this.matrixAutoUpdate=e.matrixAutoUpdate,this.matrixWorldAutoUpdate=e.matrixWorldAutoUpdate,this.matrixWorldNeedsUpdate=e.matrixWorldNeedsUpdate,this.layers.mask=e.layers.mask,this.visible=e.visible,this.castShadow=e.castShadow,this.receiveShadow=e.receiveShadow,this.frustumCulled=e.frustumCulled,this.renderOrder=e.renderOrder,this.static=e.static,this.animations=e.animations.slice(),this.userData=JSON.parse(JSON.stringify(e.userData)),t===!0)for(let t=0;t<e.children.length;t++){let n=e.children[t];this.add(n.clone())}return this}dispose(){this.dispatchEvent({type:`dispose`})}};$h.DEFAULT_UP=new Q(0,1,0),$h.DEFAULT_MATRIX_AUTO_UPDATE=!0,$h.DEFAULT_MATRIX_WORLD_AUTO_UPDATE=!0;var eg=class extends $h{constructor(){super(),this.isGroup=!0,this.type=`Group`}},tg={type:`move`},ng=class{constructor(){this._targetRay=null,this._grip=null,this._hand=null}getHandSpace(){return this._hand===null&&(this._hand=new eg,this._hand.matrixAutoUpdate=!1,this._hand.visible=!1,this._hand.joints={},this._hand.inputState={pinching:!1}),this._hand}getTargetRaySpace(){return this._targetRay===null&&(this._targetRay=new eg,this._targetRay.matrixAutoUpdate=!1,this._targetRay.visible=!1,this._targetRay.hasLinearVelocity=!1,this._targetRay.linearVelocity=new Q,this._targetRay.hasAngularVelocity=!1,this._targetRay.angularVelocity=new Q),this._targetRay}getGripSpace(){return this._grip===null&&(this._grip=new eg,this._grip.matrixAutoUpdate=!1,this._grip.visible=!1,this._grip.hasLinearVelocity=!1,this._grip.linearVelocity=new Q,this._grip.hasAngularVelocity=!1,this._grip.angularVelocity=new Q,this._grip.eventsEnabled=!1),this._grip}dispatchEvent(e){return this._targetRay!==null&&this._targetRay.dispatchEvent(e),this._grip!==null&&this._grip.dispatchEvent(e),this._hand!==null&&this._hand.dispatchEvent(e),this}connect(e){if(e&&e.hand){let t=this._hand;if(t)for(let n of e.hand.values())this._getHandJoint(t,n)}return this.dispatchEvent({type:`connected`,data:e}),this}disconnect(e){return this.dispatchEvent({type:`disconnected`,data:e}),this._targetRay!==null&&(this._targetRay.visible=!1),this._grip!==null&&(this._grip.visible=!1),this._hand!==null&&(this._hand.visible=!1),this}update(e,t,n){let r=null,i=null,a=null,o=this._targetRay,s=this._grip,c=this._hand;if(e&&t.session.visibilityState!==`visible-blurred`){if(c&&e.hand){a=!0;for(let r of e.hand.values()){let e=t.getJointPose(r,n),i=this._getHandJoint(c,r);e!==null&&(i.matrix.fromArray(e.transform.matrix),i.matrix.decompose(i.position,i.quaternion,i.scale),i.matrixWorldNeedsUpdate=!0,i.jointRadius=e.radius),i.visible=e!==null}let r=c.joints[`index-finger-tip`],i=c.joints[`thumb-tip`],o=r.position.distanceTo(i.position);c.inputState.pinching&&o>.025?(c.inputState.pinching=!1,this.dispatchEvent({type:`pinchend`,handedness:e.handedness,target:this})):!c.inputState.pinching&&o<=.015&&(c.inputState.pinching=!0,this.dispatchEvent({type:`pinchstart`,handedness:e.handedness,target:this}))}else s!==null&&e.gripSpace&&(i=t.getPose(e.gripSpace,n),i!==null&&(s.matrix.fromArray(i.transform.matrix),s.matrix.decompose(s.position,s.quaternion,s.scale),s.matrixWorldNeedsUpdate=!0,i.linearVelocity?(s.hasLinearVelocity=!0,s.linearVelocity.copy(i.linearVelocity)):s.hasLinearVelocity=!1,i.angularVelocity?(s.hasAngularVelocity=!0,s.angularVelocity.copy(i.angularVelocity)):s.hasAngularVelocity=!1,s.eventsEnabled&&s.dispatchEvent({type:`gripUpdated`,data:e,target:this})));o!==null&&(r=t.getPose(e.targetRaySpace,n),r===null&&i!==null&&(r=i),r!==null&&(o.matrix.fromArray(r.transform.matrix),o.matrix.decompose(o.position,o.quaternion,o.scale),o.matrixWorldNeedsUpdate=!0,r.linearVelocity?(o.hasLinearVelocity=!0,o.linearVelocity.copy(r.linearVelocity)):o.hasLinearVelocity=!1,r.angularVelocity?(o.hasAngularVelocity=!0,o.angularVelocity.copy(r.angularVelocity)):o.hasAngularVelocity=!1,this.dispatchEvent(tg)))}return o!==null&&(o.visible=r!==null),s!==null&&(s.visible=i!==null),c!==null&&(c.visible=a!==null),this}_getHandJoint(e,t){if(e.joints[t.jointName]===void 0){let n=new eg;n.matrixAutoUpdate=!1,n.visible=!1,e.joints[t.jointName]=n,e.add(n)}return e.joints[t.jointName]}},rg={aliceblue:15792383,antiquewhite:16444375,aqua:65535,aquamarine:8388564,azure:15794175,beige:16119260,bisque:16770244,black:0,blanchedalmond:16772045,blue:255,blueviolet:9055202,brown:10824234,burlywood:14596231,cadetblue:6266528,chartreuse:8388352,chocolate:13789470,coral:16744272,cornflowerblue:6591981,cornsilk:16775388,crimson:14423100,cyan:65535,darkblue:139,darkcyan:35723,darkgoldenrod:12092939,darkgray:11119017,darkgreen:25600,darkgrey:11119017,darkkhaki:12433259,darkmagenta:9109643,darkolivegreen:5597999,darkorange:16747520,darkorchid:10040012,darkred:9109504,darksalmon:15308410,darkseagreen:9419919,darkslateblue:4734347,darkslategray:3100495,darkslategrey:3100495,darkturquoise:52945,darkviolet:9699539,deeppink:16716947,deepskyblue:49151,dimgray:6908265,dimgrey:6908265,dodgerblue:2003199,firebrick:11674146,floralwhite:16775920,forestgreen:2263842,fuchsia:16711935,gainsboro:14474460,ghostwhite:16316671,gold:16766720,goldenrod:14329120,gray:8421504,green:32768,greenyellow:11403055,grey:8421504,honeydew:15794160,hotpink:16738740,indianred:13458524,indigo:4915330,ivory:16777200,khaki:15787660,lavender:15132410,lavenderblush:16773365,lawngreen:8190976,lemonchiffon:16775885,lightblue:11393254,lightcoral:15761536,lightcyan:14745599,lightgoldenrodyellow:16448210,lightgray:13882323,lightgreen:9498256,lightgrey:13882323,lightpink:16758465,lightsalmon:16752762,lightseagreen:2142890,lightskyblue:8900346,lightslategray:7833753,lightslategrey:7833753,lightsteelblue:11584734,lightyellow:16777184,lime:65280,limegreen:3329330,linen:16445670,magenta:16711935,maroon:8388608,mediumaquamarine:6737322,mediumblue:205,mediumorchid:12211667,mediumpurple:9662683,mediumseagreen:3978097,mediumslateblue:8087790,mediumspringgreen:64154,mediumturquoise:4772300,mediumvioletred:13047173,midnightblue:1644912,mintcream:16121850,mistyrose:16770273,moccasin:16770229,navajowhite:16768685,navy:128,oldlace:16643558,olive:8421376,olivedrab:7048739,orange:16753920,orangered:16729344,orchid:14315734,palegoldenrod:15657130,palegreen:10025880,paleturquoise:11529966,palevioletred:14381203,papayawhip:16773077,peachpuff:16767673,peru:13468991,pink:16761035,plum:14524637,powderblue:11591910,purple:8388736,rebeccapurple:6697881,red:16711680,rosybrown:12357519,royalblue:4286945,saddlebrown:9127187,salmon:16416882,sandybrown:16032864,seagreen:3050327,seashell:16774638,sienna:10506797,silver:12632256,skyblue:8900331,slateblue:6970061,slategray:7372944,slategrey:7372944,snow:16775930,springgreen:65407,steelblue:4620980,tan:13808780,teal:32896,thistle:14204888,tomato:16737095,turquoise:4251856,violet:15631086,wheat:16113331,white:16777215,whitesmoke:16119285,yellow:16776960,yellowgreen:10145074},ig={h:0,s:0,l:0},ag={h:0,s:0,l:0};function og(e,t,n){return n<0&&(n+=1),n>1&&--n,n<1/6?e+(t-e)*6*n:n<1/2?t:n<2/3?e+(t-e)*6*(2/3-n):e}var sg=class{constructor(e,t,n){return this.isColor=!0,this.r=1,this.g=1,this.b=1,this.set(e,t,n)}set(e,t,n){if(t===void 0&&n===void 0){let t=e;t&&t.isColor?this.copy(t):typeof t==`number`?this.setHex(t):typeof t==`string`&&this.setStyle(t)}else this.setRGB(e,t,n);return this}setScalar(e){return this.r=e,this.g=e,this.b=e,this}setHex(e,t=cm){return e=Math.floor(e),this.r=(e>>16&255)/255,this.g=(e>>8&255)/255,this.b=(e&255)/255,uh.colorSpaceToWorking(this,t),this}setRGB(e,t,n,r=uh.workingColorSpace){return this.r=e,this.g=t,this.b=n,uh.colorSpaceToWorking(this,r),this}setHSL(e,t,n,r=uh.workingColorSpace){if(e=Pm(e,1),t=Nm(t,0,1),n=Nm(n,0,1),t===0)this.r=this.g=this.b=n;else{let r=n<=.5?n*(1+t):n+t-n*t,i=2*n-r;this.r=og(i,r,e+1/3),this.g=og(i,r,e),this.b=og(i,r,e-1/3)}return uh.colorSpaceToWorking(this,r),this}setStyle(e,t=cm){function n(t){t!==void 0&&parseFloat(t)<1&&Sm(`Color: Alpha component of `+e+` will be ignored.`)}let r;if(r=/^(\w+)\(([^\)]*)\)/.exec(e)){let i,a=r[1],o=r[2];switch(a){case`rgb`:case`rgba`:if(i=/^\s*(\d+)\s*,\s*(\d+)\s*,\s*(\d+)\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(o))return n(i[4]),this.setRGB(Math.min(255,parseInt(i[1],10))/255,Math.min(255,parseInt(i[2],10))/255,Math.min(255,parseInt(i[3],10))/255,t);if(i=/^\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(o))return n(i[4]),this.setRGB(Math.min(100,parseFloat(i[1]))/100,Math.min(100,parseFloat(i[2]))/100,Math.min(100,parseFloat(i[3]))/100,t);break;case`hsl`:case`hsla`:if(i=/^\s*([+-]?(?:\d+(?:\.\d+)?|\.\d+))\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*,\s*(\d+(?:\.\d+)?|\.\d+)\%\s*(?:,\s*(\d+(?:\.\d+)?|\.\d+)\s*)?$/.exec(o))return n(i[4]),this.setHSL(parseFloat(i[1])/360,parseFloat(i[2])/100,parseFloat(i[3])/100,t);break;default:Sm(`Color: Unknown color model `+e)}}else if(r=/^\#([A-Fa-f\d]+)$/.exec(e)){let n=r[1],i=n.length;if(i===3)return this.setRGB(parseInt(n.charAt(0),16)/15,parseInt(n.charAt(1),16)/15,parseInt(n.charAt(2),16)/15,t);if(i===6)return this.setHex(parseInt(n,16),t);Sm(`Color: Invalid hex color `+e)}else if(e&&e.length>0)return this.setColorName(e,t);return this}setColorName(e,t=cm){let n=rg[e.toLowerCase()];return n===void 0?Sm(`Color: Unknown color `+e):this.setHex(n,t),this}clone(){return new this.constructor(this.r,this.g,this.b)}copy(e){return this.r=e.r,this.g=e.g,this.b=e.b,this}copySRGBToLinear(e){return this.r=dh(e.r),this.g=dh(e.g),this.b=dh(e.b),this}copyLinearToSRGB(e){return this.r=fh(e.r),this.g=fh(e.g),this.b=fh(e.b),this}convertSRGBToLinear(){return this.copySRGBToLinear(this),this}convertLinearToSRGB(){return this.copyLinearToSRGB(this),this}getHex(e=cm){return uh.workingToColorSpace(cg.copy(this),e),Math.round(Nm(cg.r*255,0,255))*65536+Math.round(Nm(cg.g*255,0,255))*256+Math.round(Nm(cg.b*255,0,255))}getHexString(e=cm){return(`000000`+this.getHex(e).toString(16)).slice(-6)}getHSL(e,t=uh.workingColorSpace){uh.workingToColorSpace(cg.copy(this),t);let n=cg.r,r=cg.g,i=cg.b,a=Math.max(n,r,i),o=Math.min(n,r,i),s,c,l=(o+a)/2;if(o===a)s=0,c=0;else{let e=a-o;switch(c=l<=.5?e/(a+o):e/(2-a-o),a){case n:s=(r-i)/e+(r<i?6:0);break;case r:s=(i-n)/e+2;break;case i:s=(n-r)/e+4}s/=6}return e.h=s,e.s=c,e.l=l,e}getRGB(e,t=uh.workingColorSpace){return uh.workingToColorSpace(cg.copy(this),t),e.r=cg.r,e.g=cg.g,e.b=cg.b,e}getStyle(e=cm){uh.workingToColorSpace(cg.copy(this),e);let t=cg.r,n=cg.g,r=cg.b;return e===`srgb`?`rgb(${Math.round(t*255)},${Math.round(n*255)},${Math.round(r*255)})`:`color(${e} ${t.toFixed(3)} ${n.toFixed(3)} ${r.toFixed(3)})`}offsetHSL(e,t,n){return this.getHSL(ig),this.setHSL(ig.h+e,ig.s+t,ig.l+n)}add(e){return this.r+=e.r,this.g+=e.g,this.b+=e.b,this}addColors(e,t){return this.r=e.r+t.r,this.g=e.g+t.g,this.b=e.b+t.b,this}addScalar(e){return this.r+=e,this.g+=e,this.b+=e,this}sub(e){return this.r=Math.max(0,this.r-e.r),this.g=Math.max(0,this.g-e.g),this.b=Math.max(0,this.b-e.b),this}multiply(e){return this.r*=e.r,this.g*=e.g,this.b*=e.b,this}multiplyScalar(e){return this.r*=e,this.g*=e,this.b*=e,this}lerp(e,t){return this.r+=(e.r-this.r)*t,this.g+=(e.g-this.g)*t,this.b+=(e.b-this.b)*t,this}lerpColors(e,t,n){return this.r=e.r+(t.r-e.r)*n,this.g=e.g+(t.g-e.g)*n,this.b=e.b+(t.b-e.b)*n,this}lerpHSL(e,t){this.getHSL(ig),e.getHSL(ag);let n=Lm(ig.h,ag.h,t),r=Lm(ig.s,ag.s,t),i=Lm(ig.l,ag.l,t);return this.setHSL(n,r,i),this}setFromVector3(e){return this.r=e.x,this.g=e.y,this.b=e.z,this}applyMatrix3(e){let t=this.r,n=this.g,r=this.b,i=e.elements;return this.r=i[0]*t+i[3]*n+i[6]*r,this.g=i[1]*t+i[4]*n+i[7]*r,this.b=i[2]*t+i[5]*n+i[8]*r,this}equals(e){return e.r===this.r&&e.g===this.g&&e.b===this.b}fromArray(e,t=0){return this.r=e[t],this.g=e[t+1],this.b=e[t+2],this}toArray(e=[],t=0){return e[t]=this.r,e[t+1]=this.g,e[t+2]=this.b,e}fromBufferAttribute(e,t){return this.r=e.getX(t),this.g=e.getY(t),this.b=e.getZ(t),this}toJSON(){return this.getHex()}*[Symbol.iterator](){yield this.r,yield this.g,yield this.b}},cg=new sg;sg.NAMES=rg;var lg=class extends $h{constructor(){super(),this.isScene=!0,this.type=`Scene`,this.background=null,this.environment=null,this.fog=null,this.backgroundBlurriness=0,this.backgroundIntensity=1,this.backgroundRotation=new Ih,this.environmentIntensity=1,this.environmentRotation=new Ih,this.overrideMaterial=null,typeof __THREE_DEVTOOLS__<`u`&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent(`observe`,{detail:this}))}copy(e,t){return super.copy(e,t),this.background=e.background===null?null:e.background.clone(),this.environment=e.environment===null?null:e.environment.clone(),this.fog=e.fog===null?null:e.fog.clone(),this.backgroundBlurriness=e.backgroundBlurriness,this.backgroundIntensity=e.backgroundIntensity,this.backgroundRotation.copy(e.backgroundRotation),this.environmentIntensity=e.environmentIntensity,this.environmentRotation.copy(e.environmentRotation),this.overrideMaterial=e.overrideMaterial===null?null:e.overrideMaterial.clone(),this.matrixAutoUpdate=e.matrixAutoUpdate,this}toJSON(e){let t=super.toJSON(e);return this.fog!==null&&(t.object.fog=this.fog.toJSON()),t.object.backgroundBlurriness=this.backgroundBlurriness,t.object.backgroundIntensity=this.backgroundIntensity,t.object.backgroundRotation=this.backgroundRotation.toArray(),t.object.environmentIntensity=this.environmentIntensity,t.object.environmentRotation=this.environmentRotation.toArray(),t}},ug=new Q,dg=new Q,fg=new Q,pg=new Q,mg=new Q,hg=new Q,gg=new Q,_g=new Q,vg=new Q,yg=new Q,bg=new xh,xg=new xh,Sg=new xh,Cg=class e{constructor(e=new Q,t=new Q,n=new Q){this.a=e,this.b=t,this.c=n}static getNormal(e,t,n,r){r.subVectors(n,t),ug.subVectors(e,t),r.cross(ug);let i=r.lengthSq();return i>0?r.multiplyScalar(1/Math.sqrt(i)):r.set(0,0,0)}static getBarycoord(e,t,n,r,i){ug.subVectors(r,t),dg.subVectors(n,t),fg.subVectors(e,t);let a=ug.dot(ug),o=ug.dot(dg),s=ug.dot(fg),c=dg.dot(dg),l=dg.dot(fg),u=a*c-o*o;if(u===0)return i.set(0,0,0),null;let d=1/u,f=(c*s-o*l)*d,p=(a*l-o*s)*d;return i.set(1-f-p,p,f)}static containsPoint(e,t,n,r){return this.getBarycoord(e,t,n,r,pg)!==null&&pg.x>=0&&pg.y>=0&&pg.x+pg.y<=1}static getInterpolation(e,t,n,r,i,a,o,s){return this.getBarycoord(e,t,n,r,pg)===null?(s.x=0,s.y=0,`z`in s&&(s.z=0),`w`in s&&(s.w=0),null):(s.setScalar(0),s.addScaledVector(i,pg.x),s.addScaledVector(a,pg.y),s.addScaledVector(o,pg.z),s)}static getInterpolatedAttribute(e,t,n,r,i,a){return bg.setScalar(0),xg.setScalar(0),Sg.setScalar(0),bg.fromBufferAttribute(e,t),xg.fromBufferAttribute(e,n),Sg.fromBufferAttribute(e,r),a.setScalar(0),a.addScaledVector(bg,i.x),a.addScaledVector(xg,i.y),a.addScaledVector(Sg,i.z),a}static isFrontFacing(e,t,n,r){return ug.subVectors(n,t),dg.subVectors(e,t),ug.cross(dg).dot(r)<0}set(e,t,n){return this.a.copy(e),this.b.copy(t),this.c.copy(n),this}setFromPointsAndIndices(e,t,n,r){return this.a.copy(e[t]),this.b.copy(e[n]),this.c.copy(e[r]),this}setFromAttributeAndIndices(e,t,n,r){return this.a.fromBufferAttribute(e,t),this.b.fromBufferAttribute(e,n),this.c.fromBufferAttribute(e,r),this}clone(){return new this.constructor().copy(this)}copy(e){return this.a.copy(e.a),this.b.copy(e.b),this.c.copy(e.c),this}getArea(){return ug.subVectors(this.c,this.b),dg.subVectors(this.a,this.b),ug.cross(dg).length()*.5}getMidpoint(e){return e.addVectors(this.a,this.b).add(this.c).multiplyScalar(1/3)}getNormal(t){return e.getNormal(this.a,this.b,this.c,t)}getPlane(e){return e.setFromCoplanarPoints(this.a,this.b,this.c)}getBarycoord(t,n){return e.getBarycoord(t,this.a,this.b,this.c,n)}getInterpolation(t,n,r,i,a){return e.getInterpolation(t,this.a,this.b,this.c,n,r,i,a)}containsPoint(t){return e.containsPoint(t,this.a,this.b,this.c)}isFrontFacing(t){return e.isFrontFacing(this.a,this.b,this.c,t)}intersectsBox(e){return e.intersectsTriangle(this)}closestPointToPoint(e,t){let n=this.a,r=this.b,i=this.c,a,o;mg.subVectors(r,n),hg.subVectors(i,n),_g.subVectors(e,n);let s=mg.dot(_g),c=hg.dot(_g);if(s<=0&&c<=0)return t.copy(n);vg.subVectors(e,r);let l=mg.dot(vg),u=hg.dot(vg);if(l>=0&&u<=l)return t.copy(r);let d=s*u-l*c;if(d<=0&&s>=0&&l<=0&&s-l>0)return a=s/(s-l),t.copy(n).addScaledVector(mg,a);yg.subVectors(e,i);let f=mg.dot(yg),p=hg.dot(yg);if(p>=0&&f<=p)return t.copy(i);let m=f*c-s*p;if(m<=0&&c>=0&&p<=0)return o=c/(c-p),t.copy(n).addScaledVector(hg,o);let h=l*p-f*u;if(h<=0&&u-l>=0&&f-p>=0)return gg.subVectors(i,r),o=(u-l)/(u-l+(f-p)),t.copy(r).addScaledVector(gg,o);let g=1/(h+m+d);return a=m*g,o=d*g,t.copy(n).addScaledVector(mg,a).addScaledVector(hg,o)}equals(e){return e.a.equals(this.a)&&e.b.equals(this.b)&&e.c.equals(this.c)}},wg=class{constructor(e=new Q(1/0,1/0,1/0),t=new Q(-1/0,-1/0,-1/0)){this.isBox3=!0,this.min=e,this.max=t}set(e,t){return this.min.copy(e),this.max.copy(t),this}setFromArray(e){this.makeEmpty();for(let t=0,n=e.length;t<n;t+=3)this.expandByPoint(Eg.fromArray(e,t));return this}setFromBufferAttribute(e){this.makeEmpty();for(let t=0,n=e.count;t<n;t++)this.expandByPoint(Eg.fromBufferAttribute(e,t));return this}setFromPoints(e){this.makeEmpty();for(let t=0,n=e.length;t<n;t++)this.expandByPoint(e[t]);return this}setFromCenterAndSize(e,t){let n=Eg.copy(t).multiplyScalar(.5);return this.min.copy(e).sub(n),this.max.copy(e).add(n),this}setFromObject(e,t=!1){return this.makeEmpty(),this.expandByObject(e,t)}clone(){return new this.constructor().copy(this)}copy(e){return this.min.copy(e.min),this.max.copy(e.max),this}makeEmpty(){return this.min.x=this.min.y=this.min.z=1/0,this.max.x=this.max.y=this.max.z=-1/0,this}isEmpty(){return this.max.x<this.min.x||this.max.y<this.min.y||this.max.z<this.min.z}getCenter(e){return this.isEmpty()?e.set(0,0,0):e.addVectors(this.min,this.max).multiplyScalar(.5)}getSize(e){return this.isEmpty()?e.set(0,0,0):e.subVectors(this.max,this.min)}expandByPoint(e){return this.min.min(e),this.max.max(e),this}expandByVector(e){return this.min.sub(e),this.max.add(e),this}expandByScalar(e){return this.min.addScalar(-e),this.max.addScalar(e),this}expandByObject(e,t=!1){e.updateWorldMatrix(!1,!1);let n=e.geometry;if(n!==void 0){let r=n.getAttribute(`position`);if(t===!0&&r!==void 0&&e.isInstancedMesh!==!0&&e.isBatchedMesh!==!0)for(let t=0,n=r.count;t<n;t++)e.isMesh===!0?e.getVertexPosition(t,Eg):Eg.fromBufferAttribute(r,t),Eg.applyMatrix4(e.matrixWorld),this.expandByPoint(Eg);else e.boundingBox===void 0?(n.boundingBox===null&&n.computeBoundingBox(),Dg.copy(n.boundingBox)):(e.boundingBox===null&&e.computeBoundingBox(),Dg.copy(e.boundingBox)),Dg.applyMatrix4(e.matrixWorld),this.union(Dg)}let r=e.children;for(let e=0,n=r.length;e<n;e++)this.expandByObject(r[e],t);return this}containsPoint(e){return e.x>=this.min.x&&e.x<=this.max.x&&e.y>=this.min.y&&e.y<=this.max.y&&e.z>=this.min.z&&e.z<=this.max.z}containsBox(e){return this.min.x<=e.min.x&&e.max.x<=this.max.x&&this.min.y<=e.min.y&&e.max.y<=this.max.y&&this.min.z<=e.min.z&&e.max.z<=this.max.z}getParameter(e,t){return t.set((e.x-this.min.x)/(this.max.x-this.min.x),(e.y-this.min.y)/(this.max.y-this.min.y),(e.z-this.min.z)/(this.max.z-this.min.z))}intersectsBox(e){return e.max.x>=this.min.x&&e.min.x<=this.max.x&&e.max.y>=this.min.y&&e.min.y<=this.max.y&&e.max.z>=this.min.z&&e.min.z<=this.max.z}intersectsSphere(e){return this.clampPoint(e.center,Eg),Eg.distanceToSquared(e.center)<=e.radius*e.radius}intersectsPlane(e){let t,n;return e.normal.x>0?(t=e.normal.x*this.min.x,n=e.normal.x*this.max.x):(t=e.normal.x*this.max.x,n=e.normal.x*this.min.x),e.normal.y>0?(t+=e.normal.y*this.min.y,n+=e.normal.y*this.max.y):(t+=e.normal.y*this.max.y,n+=e.normal.y*this.min.y),e.normal.z>0?(t+=e.normal.z*this.min.z,n+=e.normal.z*this.max.z):(t+=e.normal.z*this.max.z,n+=e.normal.z*this.min.z),t<=-e.constant&&n>=-e.constant}intersectsTriangle(e){if(this.isEmpty())return!1;this.getCenter(Pg),Fg.subVectors(this.max,Pg),Og.subVectors(e.a,Pg),kg.subVectors(e.b,Pg),Ag.subVectors(e.c,Pg),jg.subVectors(kg,Og),Mg.subVectors(Ag,kg),Ng.subVectors(Og,Ag);let t=[0,-jg.z,jg.y,0,-Mg.z,Mg.y,0,-Ng.z,Ng.y,jg.z,0,-jg.x,Mg.z,0,-Mg.x,Ng.z,0,-Ng.x,-jg.y,jg.x,0,-Mg.y,Mg.x,0,-Ng.y,Ng.x,0];return!Rg(t,Og,kg,Ag,Fg)||(t=[1,0,0,0,1,0,0,0,1],!Rg(t,Og,kg,Ag,Fg))?!1:(Ig.crossVectors(jg,Mg),t=[Ig.x,Ig.y,Ig.z],Rg(t,Og,kg,Ag,Fg))}clampPoint(e,t){return t.copy(e).clamp(this.min,this.max)}distanceToPoint(e){return this.clampPoint(e,Eg).distanceTo(e)}getBoundingSphere(e){return this.isEmpty()?e.makeEmpty():(this.getCenter(e.center),e.radius=this.getSize(Eg).length()*.5),e}intersect(e){return this.min.max(e.min),this.max.min(e.max),this.isEmpty()&&this.makeEmpty(),this}union(e){return this.min.min(e.min),this.max.max(e.max),this}applyMatrix4(e){return this.isEmpty()||(Tg[0].set(this.min.x,this.min.y,this.min.z).applyMatrix4(e),Tg[1].set(this.min.x,this.min.y,this.max.z).applyMatrix4(e),Tg[2].set(this.min.x,this.max.y,this.min.z).applyMatrix4(e),Tg[3].set(this.min.x,this.max.y,this.max.z).applyMatrix4(e),Tg[4].set(this.max.x,this.min.y,this.min.z).applyMatrix4(e),Tg[5].set(this.max.x,this.min.y,this.max.z).applyMatrix4(e),Tg[6].set(this.max.x,this.max.y,this.min.z).applyMatrix4(e),Tg[7].set(this.max.x,this.max.y,this.max.z).applyMatrix4(e),this.setFromPoints(Tg)),this}translate(e){return this.min.add(e),this.max.add(e),this}equals(e){return e.min.equals(this.min)&&e.max.equals(this.max)}toJSON(){return{min:this.min.toArray(),max:this.max.toArray()}}fromJSON(e){return this.min.fromArray(e.min),this.max.fromArray(e.max),this}},Tg=[new Q,new Q,new Q,new Q,new Q,new Q,new Q,new Q],Eg=new Q,Dg=new wg,Og=new Q,kg=new Q,Ag=new Q,jg=new Q,Mg=new Q,Ng=new Q,Pg=new Q,Fg=new Q,Ig=new Q,Lg=new Q;function Rg(e,t,n,r,i){for(let a=0,o=e.length-3;a<=o;a+=3){Lg.fromArray(e,a);let o=i.x*Math.abs(Lg.x)+i.y*Math.abs(Lg.y)+i.z*Math.abs(Lg.z),s=t.dot(Lg),c=n.dot(Lg),l=r.dot(Lg);if(Math.max(-Math.max(s,c,l),Math.min(s,c,l))>o)return!1}return!0}var zg=new Q,Bg=new Z,Vg=0,Hg=class extends Dm{constructor(e,t,n=!1){if(super(),Array.isArray(e))throw TypeError(`THREE.BufferAttribute: array should be a Typed Array.`);this.isBufferAttribute=!0,Object.defineProperty(this,"id",{value:Vg++}),this.name=``,this.array=e,this.itemSize=t,this.count=e===void 0?0:e.length/t,this.normalized=n,this.usage=pm,this.updateRanges=[],this.gpuType=tp,this.version=0,this._normalizationScale=e===void 0?void 0:Qm(e)}onUploadCallback(){}set needsUpdate(e){e===!0&&this.version++}setUsage(e){return this.usage=e,this}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}copy(e){return this.name=e.name,this.array=new e.array.constructor(e.array),this.itemSize=e.itemSize,this.count=e.count,this.normalized=e.normalized,this.usage=e.usage,this.gpuType=e.gpuType,this._normalizationScale=e._normalizationScale,this}copyAt(e,t,n){e*=this.itemSize,n*=t.itemSize;for(let r=0,i=this.itemSize;r<i;r++)this.array[e+r]=t.array[n+r];return this}copyArray(e){return this.array.set(e),this}applyMatrix3(e){if(this.itemSize===2)for(let t=0,n=this.count;t<n;t++)Bg.fromBufferAttribute(this,t),Bg.applyMatrix3(e),this.setXY(t,Bg.x,Bg.y);else if(this.itemSize===3)for(let t=0,n=this.count;t<n;t++)zg.fromBufferAttribute(this,t),zg.applyMatrix3(e),this.setXYZ(t,zg.x,zg.y,zg.z);return this}applyMatrix4(e){for(let t=0,n=this.count;t<n;t++)zg.fromBufferAttribute(this,t),zg.applyMatrix4(e),this.setXYZ(t,zg.x,zg.y,zg.z);return this}applyNormalMatrix(e){for(let t=0,n=this.count;t<n;t++)zg.fromBufferAttribute(this,t),zg.applyNormalMatrix(e),this.setXYZ(t,zg.x,zg.y,zg.z);return this}transformDirection(e){for(let t=0,n=this.count;t<n;t++)zg.fromBufferAttribute(this,t),zg.transformDirection(e),this.setXYZ(t,zg.x,zg.y,zg.z);return this}set(e,t=0){return this.array.set(e,t),this}getComponent(e,t){let n=this.array[e*this.itemSize+t];return this.normalized&&(n=this._denormalize(n)),n}setComponent(e,t,n){return this.normalized&&(n=this._normalize(n)),this.array[e*this.itemSize+t]=n,this}getX(e){let t=this.array[e*this.itemSize];return this.normalized&&(t=this._denormalize(t)),t}setX(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize]=t,this}getY(e){let t=this.array[e*this.itemSize+1];return this.normalized&&(t=this._denormalize(t)),t}setY(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+1]=t,this}getZ(e){let t=this.array[e*this.itemSize+2];return this.normalized&&(t=this._denormalize(t)),t}setZ(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+2]=t,this}getW(e){let t=this.array[e*this.itemSize+3];return this.normalized&&(t=this._denormalize(t)),t}setW(e,t){return this.normalized&&(t=this._normalize(t)),this.array[e*this.itemSize+3]=t,this}setXY(e,t,n){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n)),this.array[e+0]=t,this.array[e+1]=n,this}setXYZ(e,t,n,r){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n),r=this._normalize(r)),this.array[e+0]=t,this.array[e+1]=n,this.array[e+2]=r,this}setXYZW(e,t,n,r,i){return e*=this.itemSize,this.normalized&&(t=this._normalize(t),n=this._normalize(n),r=this._normalize(r),i=this._normalize(i)),this.array[e+0]=t,this.array[e+1]=n,this.array[e+2]=r,this.array[e+3]=i,this}onUpload(e){return this.onUploadCallback=e,this}clone(){return new this.constructor(this.array,this.itemSize).copy(this)}toJSON(){let e={itemSize:this.itemSize,type:this.array.constructor.name,array:Array.from(this.array),normalized:this.normalized};return e.name=this.name,e.usage=this.usage,e.gpuType=this.gpuType,e}dispose(){this.dispatchEvent({type:`dispose`})}_denormalize(e){let t=this._normalizationScale;return t===void 0?$m(e,this.array):Math.max(e/t,-1)}_normalize(e){let t=this._normalizationScale;return t===void 0?eh(e,this.array):Math.round(e*t)}},Ug=class extends Hg{constructor(e,t,n){super(new Uint16Array(e),t,n)}},Wg=class extends Hg{constructor(e,t,n){super(new Uint32Array(e),t,n)}},Gg=class extends Hg{constructor(e,t,n){super(new Float32Array(e),t,n)}},Kg=new wg,qg=new Q,Jg=new Q,Yg=class{constructor(e=new Q,t=-1){this.isSphere=!0,this.center=e,this.radius=t}set(e,t){return this.center.copy(e),this.radius=t,this}setFromPoints(e,t){let n=this.center;t===void 0?Kg.setFromPoints(e).getCenter(n):n.copy(t);let r=0;for(let t=0,i=e.length;t<i;t++)r=Math.max(r,n.distanceToSquared(e[t]));return this.radius=Math.sqrt(r),this}copy(e){return this.center.copy(e.center),this.radius=e.radius,this}isEmpty(){return this.radius<0}makeEmpty(){return this.center.set(0,0,0),this.radius=-1,this}containsPoint(e){return e.distanceToSquared(this.center)<=this.radius*this.radius}distanceToPoint(e){return e.distanceTo(this.center)-this.radius}intersectsSphere(e){let t=this.radius+e.radius;return e.center.distanceToSquared(this.center)<=t*t}intersectsBox(e){return e.intersectsSphere(this)}intersectsPlane(e){return Math.abs(e.distanceToPoint(this.center))<=this.radius}clampPoint(e,t){let n=this.center.distanceToSquared(e);return t.copy(e),n>this.radius*this.radius&&(t.sub(this.center).normalize(),t.multiplyScalar(this.radius).add(this.center)),t}getBoundingBox(e){return this.isEmpty()?(e.makeEmpty(),e):(e.set(this.center,this.center),e.expandByScalar(this.radius),e)}applyMatrix4(e){return this.center.applyMatrix4(e),this.radius*=e.getMaxScaleOnAxis(),this}translate(e){return this.center.add(e),this}expandByPoint(e){if(this.isEmpty())return this.center.copy(e),this.radius=0,this;qg.subVectors(e,this.center);let t=qg.lengthSq();if(t>this.radius*this.radius){let e=Math.sqrt(t),n=(e-this.radius)*.5;this.center.addScaledVector(qg,n/e),this.radius+=n}return this}union(e){return e.isEmpty()?this:this.isEmpty()?(this.copy(e),this):(this.center.equals(e.center)===!0?this.radius=Math.max(this.radius,e.radius):(Jg.subVectors(e.center,this.center).setLength(e.radius),this.expandByPoint(qg.copy(e.center).add(Jg)),this.expandByPoint(qg.copy(e.center).sub(Jg))),this)}equals(e){return e.center.equals(this.center)&&e.radius===this.radius}clone(){return new this.constructor().copy(this)}toJSON(){return{radius:this.radius,center:this.center.toArray()}}fromJSON(e){return this.radius=e.radius,this.center.fromArray(e.center),this}},Xg=0,Zg=new Eh,Qg=new $h,$g=new Q,e_=new wg,t_=new wg,n_=new Q,r_=class e extends Dm{constructor(){super(),this.isBufferGeometry=!0,Object.defineProperty(this,"id",{value:Xg++}),this.uuid=Mm(),this.name=``,this.type=`BufferGeometry`,this.index=null,this.indirect=null,this.indirectOffset=0,this.attributes={},this.morphAttributes={},this.morphTargetsRelative=!1,this.groups=[],this.boundingBox=null,this.boundingSphere=null,this.drawRange={start:0,count:1/0},this.userData={},this._transformed=!1}getIndex(){return this.index}setIndex(e){return this.index=Array.isArray(e)?new(hm(e)?Wg:Ug)(e,1):e,this}setIndirect(e,t=0){return this.indirect=e,this.indirectOffset=t,this}getIndirect(){return this.indirect}getAttribute(e){return this.attributes[e]}setAttribute(e,t){return this.attributes[e]=t,this}deleteAttribute(e){return delete this.attributes[e],this}hasAttribute(e){return this.attributes[e]!==void 0}addGroup(e,t,n=0){this.groups.push({start:e,count:t,materialIndex:n})}clearGroups(){this.groups=[]}setDrawRange(e,t){this.drawRange.start=e,this.drawRange.count=t}applyMatrix4(e){let t=this.attributes.position;t!==void 0&&(t.applyMatrix4(e),t.needsUpdate=!0);let n=this.attributes.normal;if(n!==void 0){let t=new ah().getNormalMatrix(e);n.applyNormalMatrix(t),n.needsUpdate=!0}let r=this.attributes.tangent;return r!==void 0&&(r.transformDirection(e),r.needsUpdate=!0),this.boundingBox!==null&&this.computeBoundingBox(),this.boundingSphere!==null&&this.computeBoundingSphere(),this._transformed=!0,this}applyQuaternion(e){return Zg.makeRotationFromQuaternion(e),this.applyMatrix4(Zg),this}rotateX(e){return Zg.makeRotationX(e),this.applyMatrix4(Zg),this}rotateY(e){return Zg.makeRotationY(e),this.applyMatrix4(Zg),this}rotateZ(e){return Zg.makeRotationZ(e),this.applyMatrix4(Zg),this}translate(e,t,n){return Zg.makeTranslation(e,t,n),this.applyMatrix4(Zg),this}scale(e,t,n){return Zg.makeScale(e,t,n),this.applyMatrix4(Zg),this}lookAt(e){return Qg.lookAt(e),Qg.updateMatrix(),this.applyMatrix4(Qg.matrix),this}center(){return this.computeBoundingBox(),this.boundingBox.getCenter($g).negate(),this.translate($g.x,$g.y,$g.z),this}setFromPoints(e){let t=this.getAttribute(`position`);if(t===void 0){let t=[];for(let n=0,r=e.length;n<r;n++){let r=e[n];t.push(r.x,r.y,r.z||0)}this.setAttribute(`position`,new Gg(t,3))}else{let n=Math.min(e.length,t.count);for(let r=0;r<n;r++){let n=e[r];t.setXYZ(r,n.x,n.y,n.z||0)}e.length>t.count&&Sm(`BufferGeometry: Buffer size too small for points data. Use .dispose() and create a new geometry.`),t.needsUpdate=!0}return this}computeBoundingBox(){this.boundingBox===null&&(this.boundingBox=new wg);let e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute)Cm(`BufferGeometry.computeBoundingBox(): GLBufferAttribute requires a manual bounding box.`,this),this.boundingBox.set(new Q(-1/0,-1/0,-1/0),new Q(1/0,1/0,1/0));else{if(e!==void 0){if(this.boundingBox.setFromBufferAttribute(e),t)for(let e=0,n=t.length;e<n;e++){let n=t[e];e_.setFromBufferAttribute(n),this.morphTargetsRelative?(n_.addVectors(this.boundingBox.min,e_.min),this.boundingBox.expandByPoint(n_),n_.addVectors(this.boundingBox.max,e_.max),this.boundingBox.expandByPoint(n_)):(this.boundingBox.expandByPoint(e_.min),this.boundingBox.expandByPoint(e_.max))}}else this.boundingBox.makeEmpty();(isNaN(this.boundingBox.min.x)||isNaN(this.boundingBox.min.y)||isNaN(this.boundingBox.min.z))&&Cm(`BufferGeometry.computeBoundingBox(): Computed min/max have NaN values. The "position" attribute is likely to have NaN values.`,this)}}computeBoundingSphere(){this.boundingSphere===null&&(this.boundingSphere=new Yg);let e=this.attributes.position,t=this.morphAttributes.position;if(e&&e.isGLBufferAttribute)Cm(`BufferGeometry.computeBoundingSphere(): GLBufferAttribute requires a manual bounding sphere.`,this),this.boundingSphere.set(new Q,1/0);else if(e){let n=this.boundingSphere.center;if(e_.setFromBufferAttribute(e),t)for(let e=0,n=t.length;e<n;e++){let n=t[e];t_.setFromBufferAttribute(n),this.morphTargetsRelative?(n_.addVectors(e_.min,t_.min),e_.expandByPoint(n_),n_.addVectors(e_.max,t_.max),e_.expandByPoint(n_)):(e_.expandByPoint(t_.min),e_.expandByPoint(t_.max))}e_.getCenter(n);let r=0;for(let t=0,i=e.count;t<i;t++)n_.fromBufferAttribute(e,t),r=Math.max(r,n.distanceToSquared(n_));if(t)for(let i=0,a=t.length;i<a;i++){let a=t[i],o=this.morphTargetsRelative;for(let t=0,i=a.count;t<i;t++)n_.fromBufferAttribute(a,t),o&&($g.fromBufferAttribute(e,t),n_.add($g)),r=Math.max(r,n.distanceToSquared(n_))}this.boundingSphere.radius=Math.sqrt(r),isNaN(this.boundingSphere.radius)&&Cm(`BufferGeometry.computeBoundingSphere(): Computed radius is NaN. The "position" attribute is likely to have NaN values.`,this)}}computeTangents(){let e=this.index,t=this.attributes;if(e===null||t.position===void 0||t.normal===void 0||t.uv===void 0){Cm(`BufferGeometry: .computeTangents() failed. Missing required attributes (index, position, normal or uv)`);return}let n=t.position,r=t.normal,i=t.uv,a=this.getAttribute(`tangent`);(a===void 0||a.count!==n.count)&&(a=new Hg(new Float32Array(4*n.count),4),this.setAttribute(`tangent`,a));let o=[],s=[],c=new Uint8Array(n.count);for(let e=0;e<n.count;e++)o[e]=new Q,s[e]=new Q;let l=new Q,u=new Q,d=new Q,f=new Z,p=new Z,m=new Z,h=new Q,g=new Q;function _(e,t,r){c[e]=c[t]=c[r]=1,l.fromBufferAttribute(n,e),u.fromBufferAttribute(n,t),d.fromBufferAttribute(n,r),f.fromBufferAttribute(i,e),p.fromBufferAttribute(i,t),m.fromBufferAttribute(i,r),u.sub(l),d.sub(l),p.sub(f),m.sub(f);let a=1/(p.x*m.y-m.x*p.y);isFinite(a)&&(h.copy(u).multiplyScalar(m.y).addScaledVector(d,-p.y).multiplyScalar(a),g.copy(d).multiplyScalar(p.x).addScaledVector(u,-m.x).multiplyScalar(a),o[e].add(h),o[t].add(h),o[r].add(h),s[e].add(g),s[t].add(g),s[r].add(g))}let v=this.groups;v.length===0&&(v=[{start:0,count:e.count}]);for(let t=0,n=v.length;t<n;++t){let n=v[t],r=n.start,i=n.count;for(let t=r,n=r+i;t<n;t+=3)_(e.getX(t+0),e.getX(t+1),e.getX(t+2))}let y=new Q,b=new Q,x=new Q,S=new Q;function C(e){x.fromBufferAttribute(r,e),S.copy(x);let t=o[e];y.copy(t),y.sub(x.multiplyScalar(x.dot(t))).normalize(),b.crossVectors(S,t);let n=b.dot(s[e])<0?-1:1;a.setXYZW(e,y.x,y.y,y.z,n)}for(let e=0,t=n.count;e<t;++e)c[e]&&C(e);this._transformed=!0}computeVertexNormals(){let e=this.index,t=this.getAttribute(`position`);if(t!==void 0){let n=this.getAttribute(`normal`);if(n===void 0||n.count!==t.count)n=new Hg(new Float32Array(t.count*3),3),this.setAttribute(`normal`,n);else for(let e=0,t=n.count;e<t;e++)n.setXYZ(e,0,0,0);let r=new Q,i=new Q,a=new Q,o=new Q,s=new Q,c=new Q,l=new Q,u=new Q;if(e)for(let d=0,f=e.count;d<f;d+=3){let f=e.getX(d+0),p=e.getX(d+1),m=e.getX(d+2);r.fromBufferAttribute(t,f),i.fromBufferAttribute(t,p),a.fromBufferAttribute(t,m),l.subVectors(a,i),u.subVectors(r,i),l.cross(u),o.fromBufferAttribute(n,f),s.fromBufferAttribute(n,p),c.fromBufferAttribute(n,m),o.add(l),s.add(l),c.add(l),n.setXYZ(f,o.x,o.y,o.z),n.setXYZ(p,s.x,s.y,s.z),n.setXYZ(m,c.x,c.y,c.z)}else for(let e=0,o=t.count;e<o;e+=3)r.fromBufferAttribute(t,e+0),i.fromBufferAttribute(t,e+1),a.fromBufferAttribute(t,e+2),l.subVectors(a,i),u.subVectors(r,i),l.cross(u),n.setXYZ(e+0,l.x,l.y,l.z),n.setXYZ(e+1,l.x,l.y,l.z),n.setXYZ(e+2,l.x,l.y,l.z);this.normalizeNormals(),n.needsUpdate=!0}}normalizeNormals(){let e=this.attributes.normal;for(let t=0,n=e.count;t<n;t++)n_.fromBufferAttribute(e,t),n_.normalize(),e.setXYZ(t,n_.x,n_.y,n_.z)}toNonIndexed(){function t(e,t){let n=e.array,r=e.itemSize,i=e.normalized,a=new n.constructor(t.length*r),o=0,s=0;for(let i=0,c=t.length;i<c;i++){o=e.isInterleavedBufferAttribute?t[i]*e.data.stride+e.offset:t[i]*r;for(let e=0;e<r;e++)a[s++]=n[o++]}return new Hg(a,r,i)}if(this.index===null)return Sm(`BufferGeometry.toNonIndexed(): BufferGeometry is already non-indexed.`),this;let n=new e,r=this.index.array,i=this.attributes;for(let e in i){let a=i[e],o=t(a,r);n.setAttribute(e,o)}let a=this.morphAttributes;for(let e in a){let i=[],o=a[e];for(let e=0,n=o.length;e<n;e++){let n=o[e],a=t(n,r);i.push(a)}n.morphAttributes[e]=i}n.morphTargetsRelative=this.morphTargetsRelative;let o=this.groups;for(let e=0,t=o.length;e<t;e++){let t=o[e];n.addGroup(t.start,t.count,t.materialIndex)}return n}toJSON(){let e={metadata:{version:4.7,type:`BufferGeometry`,generator:`BufferGeometry.toJSON`}};if(e.uuid=this.uuid,e.type=this.parameters!==void 0&&this._transformed===!0?`BufferGeometry`:this.type,e.name=this.name,Object.keys(this.userData).length>0&&(e.userData=this.userData),this.parameters!==void 0&&this._transformed!==!0){let t=this.parameters;for(let n in t)t[n]!==void 0&&(e[n]=t[n]);return e}e.data={attributes:{}};let t=this.index;t!==null&&(e.data.index={type:t.array.constructor.name,array:Array.prototype.slice.call(t.array)});let n=this.attributes;for(let t in n){let r=n[t];e.data.attributes[t]=r.toJSON(e.data)}let r={},i=!1;for(let t in this.morphAttributes){let n=this.morphAttributes[t],a=[];for(let t=0,r=n.length;t<r;t++){let r=n[t];a.push(r.toJSON(e.data))}a.length>0&&(r[t]=a,i=!0)}i&&(e.data.morphAttributes=r,e.data.morphTargetsRelative=this.morphTargetsRelative);let a=this.groups;a.length>0&&(e.data.groups=JSON.parse(JSON.stringify(a)));let o=this.boundingSphere;return o!==null&&(e.data.boundingSphere=o.toJSON()),e}clone(){return new this.constructor().copy(this)}copy(e){this.index=null,this.attributes={},this.morphAttributes={},this.groups=[],this.boundingBox=null,this.boundingSphere=null;let t={};this.name=e.name;let n=e.index;n!==null&&this.setIndex(n.clone());let r=e.attributes;for(let e in r){let n=r[e];this.setAttribute(e,n.clone(t))}let i=e.morphAttributes;for(let e in i){let n=[],r=i[e];for(let e=0,i=r.length;e<i;e++)n.push(r[e].clone(t));this.morphAttributes[e]=n}this.morphTargetsRelative=e.morphTargetsRelative;let a=e.groups;for(let e=0,t=a.length;e<t;e++){let t=a[e];this.addGroup(t.start,t.count,t.materialIndex)}let o=e.boundingBox;o!==null&&(this.boundingBox=o.clone());let s=e.boundingSphere;return s!==null&&(this.boundingSphere=s.clone()),this.drawRange.start=e.drawRange.start,this.drawRange.count=e.drawRange.count,this.userData=e.userData,this._transformed=e._transformed,this}dispose(){this.dispatchEvent({type:`dispose`})}},i_=class{constructor(e,t){this.isInterleavedBuffer=!0,this.array=e,this.stride=t,this.count=e===void 0?0:e.length/t,this.usage=pm,this.updateRanges=[],this.version=0,this.uuid=Mm()}onUploadCallback(){}set needsUpdate(e){e===!0&&this.version++}setUsage(e){return this.usage=e,this}addUpdateRange(e,t){this.updateRanges.push({start:e,count:t})}clearUpdateRanges(){this.updateRanges.length=0}copy(e){return this.array=new e.array.constructor(e.array),this.count=e.count,this.stride=e.stride,this.usage=e.usage,this}copyAt(e,t,n){e*=this.stride,n*=t.stride;for(let r=0,i=this.stride;r<i;r++)this.array[e+r]=t.array[n+r];return this}set(e,t=0){return this.array.set(e,t),this}clone(e){e.arrayBuffers===void 0&&(e.arrayBuffers={});let t=a_(this.array);e.arrayBuffers[t]===void 0&&(e.arrayBuffers[t]=this.array.slice(0).buffer);let n=new this.array.constructor(e.arrayBuffers[t]),r=new this.constructor(n,this.stride);return r.setUsage(this.usage),r}onUpload(e){return this.onUploadCallback=e,this}toJSON(e){e.arrayBuffers===void 0&&(e.arrayBuffers={});let t=a_(this.array);e.arrayBuffers[t]===void 0&&(e.arrayBuffers[t]=Array.from(new Uint32Array(this.array.slice(0).buffer)));let n={uuid:this.uuid,buffer:t,type:this.array.constructor.name,stride:this.stride};return n.usage=this.usage,n}};function a_(e){return e.buffer._uuid===void 0&&(e.buffer._uuid=Mm()),e.byteOffset===0&&e.byteLength===e.buffer.byteLength?e.buffer._uuid:e.buffer._uuid+`:`+e.byteOffset+`:`+e.byteLength}var o_=new Q,s_=class e{constructor(e,t,n,r=!1){this.isInterleavedBufferAttribute=!0,this.name=``,this.data=e,this.itemSize=t,this.offset=n,this.normalized=r,this._normalizationScale=e===void 0?void 0:Qm(e.array)}get count(){return this.data.count}get array(){return this.data.array}set needsUpdate(e){this.data.needsUpdate=e}applyMatrix4(e){for(let t=0,n=this.data.count;t<n;t++)o_.fromBufferAttribute(this,t),o_.applyMatrix4(e),this.setXYZ(t,o_.x,o_.y,o_.z);return this}applyNormalMatrix(e){for(let t=0,n=this.count;t<n;t++)o_.fromBufferAttribute(this,t),o_.applyNormalMatrix(e),this.setXYZ(t,o_.x,o_.y,o_.z);return this}transformDirection(e){for(let t=0,n=this.count;t<n;t++)o_.fromBufferAttribute(this,t),o_.transformDirection(e),this.setXYZ(t,o_.x,o_.y,o_.z);return this}getComponent(e,t){let n=this.array[e*this.data.stride+this.offset+t];return this.normalized&&(n=this._denormalize(n)),n}setComponent(e,t,n){return this.normalized&&(n=this._normalize(n)),this.data.array[e*this.data.stride+this.offset+t]=n,this}setX(e,t){return this.normalized&&(t=this._normalize(t)),this.data.array[e*this.data.stride+this.offset]=t,this}setY(e,t){return this.normalized&&(t=this._normalize(t)),this.data.array[e*this.data.stride+this.offset+1]=t,this}setZ(e,t){return this.normalized&&(t=this._normalize(t)),this.data.array[e*this.data.stride+this.offset+2]=t,this}setW(e,t){return this.normalized&&(t=this._normalize(t)),this.data.array[e*this.data.stride+this.offset+3]=t,this}getX(e){let t=this.data.array[e*this.data.stride+this.offset];return this.normalized&&(t=this._denormalize(t)),t}getY(e){let t=this.data.array[e*this.data.stride+this.offset+1];return this.normalized&&(t=this._denormalize(t)),t}getZ(e){let t=this.data.array[e*this.data.stride+this.offset+2];return this.normalized&&(t=this._denormalize(t)),t}getW(e){let t=this.data.array[e*this.data.stride+this.offset+3];return this.normalized&&(t=this._denormalize(t)),t}setXY(e,t,n){return e=e*this.data.stride+this.offset,this.normalized&&(t=this._normalize(t),n=this._normalize(n)),this.data.array[e+0]=t,this.data.array[e+1]=n,this}setXYZ(e,t,n,r){return e=e*this.data.stride+this.offset,this.normalized&&(t=this._normalize(t),n=this._normalize(n),r=this._normalize(r)),this.data.array[e+0]=t,this.data.array[e+1]=n,this.data.array[e+2]=r,this}setXYZW(e,t,n,r,i){return e=e*this.data.stride+this.offset,this.normalized&&(t=this._normalize(t),n=this._normalize(n),r=this._normalize(r),i=this._normalize(i)),this.data.array[e+0]=t,this.data.array[e+1]=n,this.data.array[e+2]=r,this.data.array[e+3]=i,this}clone(t){if(t===void 0){bm(`InterleavedBufferAttribute.clone(): Cloning an interleaved buffer attribute will de-interleave buffer data.`);let e=[];for(let t=0;t<this.count;t++){let n=t*this.data.stride+this.offset;for(let t=0;t<this.itemSize;t++)e.push(this.data.array[n+t])}return new Hg(new this.array.constructor(e),this.itemSize,this.normalized)}return t.interleavedBuffers===void 0&&(t.interleavedBuffers={}),t.interleavedBuffers[this.data.uuid]===void 0&&(t.interleavedBuffers[this.data.uuid]=this.data.clone(t)),new e(t.interleavedBuffers[this.data.uuid],this.itemSize,this.offset,this.normalized)}toJSON(e){if(e===void 0){bm(`InterleavedBufferAttribute.toJSON(): Serializing an interleaved buffer attribute will de-interleave buffer data.`);let e=[];for(let t=0;t<this.count;t++){let n=t*this.data.stride+this.offset;for(let t=0;t<this.itemSize;t++)e.push(this.data.array[n+t])}return{itemSize:this.itemSize,type:this.array.constructor.name,array:e,normalized:this.normalized}}return e.interleavedBuffers===void 0&&(e.interleavedBuffers={}),e.interleavedBuffers[this.data.uuid]===void 0&&(e.interleavedBuffers[this.data.uuid]=this.data.toJSON(e)),{isInterleavedBufferAttribute:!0,itemSize:this.itemSize,data:this.data.uuid,offset:this.offset,normalized:this.normalized}}_denormalize(e){let t=this._normalizationScale;return t===void 0?$m(e,this.data.array):Math.max(e/t,-1)}_normalize(e){let t=this._normalizationScale;return t===void 0?eh(e,this.data.array):Math.round(e*t)}},c_=new Q,l_=new Q,u_=new ah,d_=class{constructor(e=new Q(1,0,0),t=0){this.isPlane=!0,this.normal=e,this.constant=t}set(e,t){return this.normal.copy(e),this.constant=t,this}setComponents(e,t,n,r){return this.normal.set(e,t,n),this.constant=r,this}setFromNormalAndCoplanarPoint(e,t){return this.normal.copy(e),this.constant=-t.dot(this.normal),this}setFromCoplanarPoints(e,t,n){let r=c_.subVectors(n,t).cross(l_.subVectors(e,t)).normalize();return this.setFromNormalAndCoplanarPoint(r,e),this}copy(e){return this.normal.copy(e.normal),this.constant=e.constant,this}normalize(){let e=1/this.normal.length();return this.normal.multiplyScalar(e),this.constant*=e,this}negate(){return this.constant*=-1,this.normal.negate(),this}distanceToPoint(e){return this.normal.dot(e)+this.constant}distanceToSphere(e){return this.distanceToPoint(e.center)-e.radius}projectPoint(e,t){return t.copy(e).addScaledVector(this.normal,-this.distanceToPoint(e))}intersectLine(e,t,n=!0){let r=e.delta(c_),i=this.normal.dot(r);if(i===0)return this.distanceToPoint(e.start)===0?t.copy(e.start):null;let a=-(e.start.dot(this.normal)+this.constant)/i;return n===!0&&(a<0||a>1)?null:t.copy(e.start).addScaledVector(r,a)}intersectsLine(e){let t=this.distanceToPoint(e.start),n=this.distanceToPoint(e.end);return t<0&&n>0||n<0&&t>0}intersectsBox(e){return e.intersectsPlane(this)}intersectsSphere(e){return e.intersectsPlane(this)}coplanarPoint(e){return e.copy(this.normal).multiplyScalar(-this.constant)}applyMatrix4(e,t){let n=t||u_.getNormalMatrix(e),r=this.coplanarPoint(c_).applyMatrix4(e),i=this.normal.applyMatrix3(n).normalize();return this.constant=-r.dot(i),this}translate(e){return this.constant-=e.dot(this.normal),this}equals(e){return e.normal.equals(this.normal)&&e.constant===this.constant}clone(){return new this.constructor().copy(this)}toJSON(){return{normal:this.normal.toArray(),constant:this.constant}}fromJSON(e){return this.normal.fromArray(e.normal),this.constant=e.constant,this}},f_=0,p_=class extends Dm{constructor(){super(),this.isMaterial=!0,Object.defineProperty(this,"id",{value:f_++}),this.uuid=Mm(),this.name=``,this.type=`Material`,this.blending=1,this.side=0,this.vertexColors=!1,this.opacity=1,this.transparent=!1,this.alphaHash=!1,this.blendSrc=204,this.blendDst=205,this.blendEquation=100,this.blendSrcAlpha=null,this.blendDstAlpha=null,this.blendEquationAlpha=null,this.blendColor=new sg(0,0,0),this.blendAlpha=0,this.depthFunc=3,this.depthTest=!0,this.depthWrite=!0,this.stencilWriteMask=255,this.stencilFunc=519,this.stencilRef=0,this.stencilFuncMask=255,this.stencilFail=fm,this.stencilZFail=fm,this.stencilZPass=fm,this.stencilWrite=!1,this.clippingPlanes=null,this.clipIntersection=!1,this.clipShadows=!1,this.shadowSide=null,this.colorWrite=!0,this.precision=null,this.polygonOffset=!1,this.polygonOffsetFactor=0,this.polygonOffsetUnits=0,this.dithering=!1,this.alphaToCoverage=!1,this.premultipliedAlpha=!1,this.forceSinglePass=!1,this.allowOverride=!0,this.visible=!0,this.toneMapped=!0,this.userData={},this.version=0,this._alphaTest=0}get alphaTest(){return this._alphaTest}set alphaTest(e){this._alphaTest>0!=e>0&&this.version++,this._alphaTest=e}onBeforeRender(){}onBeforeCompile(){}customProgramCacheKey(){return this.onBeforeCompile.toString()}setValues(e){if(e!==void 0)for(let t in e){let n=e[t];if(n===void 0){Sm(`Material: parameter '${t}' has value of undefined.`);continue}let r=this[t];r===void 0?Sm(`Material: '${t}' is not a property of THREE.${this.type}.`):r&&r.isColor?r.set(n):r&&r.isVector2&&n&&n.isVector2||r&&r.isEuler&&n&&n.isEuler||r&&r.isVector3&&n&&n.isVector3?r.copy(n):this[t]=n}}toJSON(e){let t=e===void 0||typeof e==`string`;t&&(e={textures:{},images:{}});let n={metadata:{version:4.7,type:`Material`,generator:`Material.toJSON`}};n.uuid=this.uuid,n.type=this.type,n.blending=this.blending,n.side=this.side,n.shadowSide=this.shadowSide,n.vertexColors=this.vertexColors,n.opacity=this.opacity,n.transparent=this.transparent,n.blendSrc=this.blendSrc,n.blendDst=this.blendDst,n.blendEquation=this.blendEquation,n.blendSrcAlpha=this.blendSrcAlpha,n.blendDstAlpha=this.blendDstAlpha,n.blendEquationAlpha=this.blendEquationAlpha,n.blendColor=this.blendColor.getHex(),n.blendAlpha=this.blendAlpha,n.depthFunc=this.depthFunc,n.depthTest=this.depthTest,n.depthWrite=this.depthWrite,n.colorWrite=this.colorWrite,n.clipIntersection=this.clipIntersection,n.clipShadows=this.clipShadows,n.stencilWriteMask=this.stencilWriteMask,n.stencilFunc=this.stencilFunc,n.stencilRef=this.stencilRef,n.stencilFuncMask=this.stencilFuncMask,n.stencilFail=this.stencilFail,n.stencilZFail=this.stencilZFail,n.stencilZPass=this.stencilZPass,n.stencilWrite=this.stencilWrite,n.polygonOffset=this.polygonOffset,n.polygonOffsetFactor=this.polygonOffsetFactor,n.polygonOffsetUnits=this.polygonOffsetUnits,n.dithering=this.dithering,n.alphaTest=this.alphaTest,n.alphaHash=this.alphaHash,n.alphaToCoverage=this.alphaToCoverage,n.premultipliedAlpha=this.premultipliedAlpha,n.forceSinglePass=this.forceSinglePass,n.allowOverride=this.allowOverride,n.visible=this.visible,n.toneMapped=this.toneMapped,n.name=this.name,this.color&&this.color.isColor&&(n.color=this.color.getHex()),this.roughness!==void 0&&(n.roughness=this.roughness),this.metalness!==void 0&&(n.metalness=this.metalness),this.sheen!==void 0&&(n.sheen=this.sheen),this.sheenColor&&this.sheenColor.isColor&&(n.sheenColor=this.sheenColor.getHex()),this.sheenRoughness!==void 0&&(n.sheenRoughness=this.sheenRoughness),this.emissive&&this.emissive.isColor&&(n.emissive=this.emissive.getHex()),this.emissiveIntensity!==void 0&&(n.emissiveIntensity=this.emissiveIntensity),this.specular&&this.specular.isColor&&(n.specular=this.specular.getHex()),this.specularIntensity!==void 0&&(n.specularIntensity=this.specularIntensity),this.specularColor&&this.specularColor.isColor&&(n.specularColor=this.specularColor.getHex()),this.shininess!==void 0&&(n.shininess=this.shininess),this.clearcoat!==void 0&&(n.clearcoat=this.clearcoat),this.clearcoatRoughness!==void 0&&(n.clearcoatRoughness=this.clearcoatRoughness),this.diffuseRoughness!==void 0&&(n.diffuseRoughness=this.diffuseRoughness),this.diffuseRoughnessMap&&this.diffuseRoughnessMap.isTexture&&(n.diffuseRoughnessMap=this.diffuseRoughnessMap.toJSON(e).uuid),this.clearcoatMap&&this.clearcoatMap.isTexture&&(n.clearcoatMap=this.clearcoatMap.toJSON(e).uuid),this.clearcoatRoughnessMap&&this.clearcoatRoughnessMap.isTexture&&(n.clearcoatRoughnessMap=this.clearcoatRoughnessMap.toJSON(e).uuid),this.clearcoatNormalMap&&this.clearcoatNormalMap.isTexture&&(n.clearcoatNormalMap=this.clearcoatNormalMap.toJSON(e).uuid,n.clearcoatNormalScale=this.clearcoatNormalScale.toArray()),this.sheenColorMap&&this.sheenColorMap.isTexture&&(n.sheenColorMap=this.sheenColorMap.toJSON(e).uuid),this.sheenRoughnessMap&&this.sheenRoughnessMap.isTexture&&(n.sheenRoughnessMap=this.sheenRoughnessMap.toJSON(e).uuid),this.dispersion!==void 0&&(n.dispersion=this.dispersion),this.retroreflectivity!==void 0&&(n.retroreflectivity=this.retroreflectivity),this.iridescence!==void 0&&(n.iridescence=this.iridescence),this.iridescenceIOR!==void 0&&(n.iridescenceIOR=this.iridescenceIOR),this.iridescenceThicknessMinimum!==void 0&&(n.iridescenceThicknessMinimum=this.iridescenceThicknessMinimum),this.iridescenceThicknessMaximum!==void 0&&(n.iridescenceThicknessMaximum=this.iridescenceThicknessMaximum),this.iridescenceMap&&this.iridescenceMap.isTexture&&(n.iridescenceMap=this.iridescenceMap.toJSON(e).uuid),this.iridescenceThicknessMap&&this.iridescenceThicknessMap.isTexture&&(n.iridescenceThicknessMap=this.iridescenceThicknessMap.toJSON(e).uuid),this.anisotropy!==void 0&&(n.anisotropy=this.anisotropy),this.anisotropyRotation!==void 0&&(n.anisotropyRotation=this.anisotropyRotation),this.anisotropyMap&&this.anisotropyMap.isTexture&&(n.anisotropyMap=this.anisotropyMap.toJSON(e).uuid),this.map&&this.map.isTexture&&(n.map=this.map.toJSON(e).uuid),this.matcap&&this.matcap.isTexture&&(n.matcap=this.matcap.toJSON(e).uuid),this.alphaMap&&this.alphaMap.isTexture&&(n.alphaMap=this.alphaMap.toJSON(e).uuid),this.lightMap&&this.lightMap.isTexture&&(n.lightMap=this.lightMap.toJSON(e).uuid,n.lightMapIntensity=this.lightMapIntensity),this.aoMap&&this.aoMap.isTexture&&(n.aoMap=this.aoMap.toJSON(e).uuid,n.aoMapIntensity=this.aoMapIntensity),this.bumpMap&&this.bumpMap.isTexture&&(n.bumpMap=this.bumpMap.toJSON(e).uuid,n.bumpScale=this.bumpScale),this.normalMap&&this.normalMap.isTexture&&(n.normalMap=this.normalMap.toJSON(e).uuid,n.normalMapType=this.normalMapType,n.normalScale=this.normalScale.toArray()),this.displacementMap&&this.displacementMap.isTexture&&(n.displacementMap=this.displacementMap.toJSON(e).uuid,n.displacementScale=this.displacementScale,n.displacementBias=this.displacementBias),this.roughnessMap&&this.roughnessMap.isTexture&&(n.roughnessMap=this.roughnessMap.toJSON(e).uuid),this.metalnessMap&&this.metalnessMap.isTexture&&(n.metalnessMap=this.metalnessMap.toJSON(e).uuid),this.emissiveMap&&this.emissiveMap.isTexture&&(n.emissiveMap=this.emissiveMap.toJSON(e).uuid),this.specularMap&&this.specularMap.isTexture&&(n.specularMap=this.specularMap.toJSON(e).uuid),this.specularIntensityMap&&this.specularIntensityMap.isTexture&&(n.specularIntensityMap=this.specularIntensityMap.toJSON(e).uuid),this.specularColorMap&&this.specularColorMap.isTexture&&(n.specularColorMap=this.specularColorMap.toJSON(e).uuid),this.envMap&&this.envMap.isTexture&&(n.envMap=this.envMap.toJSON(e).uuid,this.combine!==void 0&&(n.combine=this.combine)),this.envMapRotation!==void 0&&(n.envMapRotation=this.envMapRotation.toArray()),this.envMapIntensity!==void 0&&(n.envMapIntensity=this.envMapIntensity),this.reflectivity!==void 0&&(n.reflectivity=this.reflectivity),this.refractionRatio!==void 0&&(n.refractionRatio=this.refractionRatio),this.gradientMap&&this.gradientMap.isTexture&&(n.gradientMap=this.gradientMap.toJSON(e).uuid),this.transmission!==void 0&&(n.transmission=this.transmission),this.transmissionMap&&this.transmissionMap.isTexture&&(n.transmissionMap=this.transmissionMap.toJSON(e).uuid),this.thickness!==void 0&&(n.thickness=this.thickness),this.thicknessMap&&this.thicknessMap.isTexture&&(n.thicknessMap=this.thicknessMap.toJSON(e).uuid),this.attenuationDistance!==void 0&&(n.attenuationDistance=this.attenuationDistance),this.attenuationColor!==void 0&&(n.attenuationColor=this.attenuationColor.getHex()),this.size!==void 0&&(n.size=this.size),this.sizeAttenuation!==void 0&&(n.sizeAttenuation=this.sizeAttenuation),Array.isArray(this.clippingPlanes)&&this.clippingPlanes.length>0&&(n.clippingPlanes=this.clippingPlanes.map(e=>e.toJSON())),this.rotation!==void 0&&(n.rotation=this.rotation),this.depthPacking!==void 0&&(n.depthPacking=this.depthPacking),this.linewidth!==void 0&&(n.linewidth=this.linewidth),this.linecap!==void 0&&(n.linecap=this.linecap),this.linejoin!==void 0&&(n.linejoin=this.linejoin),this.dashSize!==void 0&&(n.dashSize=this.dashSize),this.gapSize!==void 0&&(n.gapSize=this.gapSize),this.scale!==void 0&&(n.scale=this.scale),this.wireframe!==void 0&&(n.wireframe=this.wireframe),this.wireframeLinewidth!==void 0&&(n.wireframeLinewidth=this.wireframeLinewidth),this.wireframeLinecap!==void 0&&(n.wireframeLinecap=this.wireframeLinecap),this.wireframeLinejoin!==void 0&&(n.wireframeLinejoin=this.wireframeLinejoin),this.flatShading!==void 0&&(n.flatShading=this.flatShading),this.fog!==void 0&&(n.fog=this.fog),Object.keys(this.userData).length>0&&(n.userData=this.userData);function r(e){let t=[];for(let n in e){let r=e[n];delete r.metadata,t.push(r)}return t}if(t){let t=r(e.textures),i=r(e.images);t.length>0&&(n.textures=t),i.length>0&&(n.images=i)}return n}fromJSON(e,t){if(e.uuid!==void 0&&(this.uuid=e.uuid),e.name!==void 0&&(this.name=e.name),e.color!==void 0&&this.color!==void 0&&this.color.setHex(e.color),e.roughness!==void 0&&(this.roughness=e.roughness),e.metalness!==void 0&&(this.metalness=e.metalness),e.sheen!==void 0&&(this.sheen=e.sheen),e.sheenColor!==void 0&&(this.sheenColor=new sg().setHex(e.sheenColor)),e.sheenRoughness!==void 0&&(this.sheenRoughness=e.sheenRoughness),e.emissive!==void 0&&this.emissive!==void 0&&this.emissive.setHex(e.emissive),e.specular!==void 0&&this.specular!==void 0&&this.specular.setHex(e.specular),e.specularIntensity!==void 0&&(this.specularIntensity=e.specularIntensity),e.specularColor!==void 0&&this.specularColor!==void 0&&this.specularColor.setHex(e.specularColor),e.shininess!==void 0&&(this.shininess=e.shininess),e.clearcoat!==void 0&&(this.clearcoat=e.clearcoat),e.clearcoatRoughness!==void 0&&(this.clearcoatRoughness=e.clearcoatRoughness),e.diffuseRoughness!==void 0&&(this.diffuseRoughness=e.diffuseRoughness),e.dispersion!==void 0&&(this.dispersion=e.dispersion),e.retroreflectivity!==void 0&&(this.retroreflectivity=e.retroreflectivity),e.iridescence!==void 0&&(this.iridescence=e.iridescence),e.iridescenceIOR!==void 0&&(this.iridescenceIOR=e.iridescenceIOR),e.iridescenceThicknessMinimum!==void 0&&(this.iridescenceThicknessMinimum=e.iridescenceThicknessMinimum),e.iridescenceThicknessMaximum!==void 0&&(this.iridescenceThicknessMaximum=e.iridescenceThicknessMaximum),e.iridescenceThicknessRange!==void 0&&(this.iridescenceThicknessMinimum=e.iridescenceThicknessRange[0],this.iridescenceThicknessMaximum=e.iridescenceThicknessRange[1]),e.transmission!==void 0&&(this.transmission=e.transmission),e.thickness!==void 0&&(this.thickness=e.thickness),e.attenuationDistance!==void 0&&(this.attenuationDistance=e.attenuationDistance),e.attenuationColor!==void 0&&this.attenuationColor!==void 0&&this.attenuationColor.setHex(e.attenuationColor),e.anisotropy!==void 0&&(this.anisotropy=e.anisotropy),e.anisotropyRotation!==void 0&&(this.anisotropyRotation=e.anisotropyRotation),e.fog!==void 0&&(this.fog=e.fog),e.flatShading!==void 0&&(this.flatShading=e.flatShading),e.blending!==void 0&&(this.blending=e.blending),e.combine!==void 0&&(this.combine=e.combine),e.side!==void 0&&(this.side=e.side),e.shadowSide!==void 0&&(this.shadowSide=e.shadowSide),e.opacity!==void 0&&(this.opacity=e.opacity),e.transparent!==void 0&&(this.transparent=e.transparent),e.alphaTest!==void 0&&(this.alphaTest=e.alphaTest),e.alphaHash!==void 0&&(this.alphaHash=e.alphaHash),e.depthFunc!==void 0&&(this.depthFunc=e.depthFunc),e.depthTest!==void 0&&(this.depthTest=e.depthTest),e.depthWrite!==void 0&&(this.depthWrite=e.depthWrite),e.colorWrite!==void 0&&(this.colorWrite=e.colorWrite),e.clippingPlanes!==void 0&&(this.clippingPlanes=e.clippingPlanes.map(e=>new d_().fromJSON(e))),e.clipIntersection!==void 0&&(this.clipIntersection=e.clipIntersection),e.clipShadows!==void 0&&(this.clipShadows=e.clipShadows),e.depthPacking!==void 0&&(this.depthPacking=e.depthPacking),e.blendSrc!==void 0&&(this.blendSrc=e.blendSrc),e.blendDst!==void 0&&(this.blendDst=e.blendDst),e.blendEquation!==void 0&&(this.blendEquation=e.blendEquation),e.blendSrcAlpha!==void 0&&(this.blendSrcAlpha=e.blendSrcAlpha),e.blendDstAlpha!==void 0&&(this.blendDstAlpha=e.blendDstAlpha),e.blendEquationAlpha!==void 0&&(this.blendEquationAlpha=e.blendEquationAlpha),e.blendColor!==void 0&&this.blendColor!==void 0&&this.blendColor.setHex(e.blendColor),e.blendAlpha!==void 0&&(this.blendAlpha=e.blendAlpha),e.stencilWriteMask!==void 0&&(this.stencilWriteMask=e.stencilWriteMask),e.stencilFunc!==void 0&&(this.stencilFunc=e.stencilFunc),e.stencilRef!==void 0&&(this.stencilRef=e.stencilRef),e.stencilFuncMask!==void 0&&(this.stencilFuncMask=e.stencilFuncMask),e.stencilFail!==void 0&&(this.stencilFail=e.stencilFail),e.stencilZFail!==void 0&&(this.stencilZFail=e.stencilZFail),e.stencilZPass!==void 0&&(this.stencilZPass=e.stencilZPass),e.stencilWrite!==void 0&&(this.stencilWrite=e.stencilWrite),e.wireframe!==void 0&&(this.wireframe=e.wireframe),e.wireframeLinewidth!==void 0&&(this.wireframeLinewidth=e.wireframeLinewidth),e.wireframeLinecap!==void 0&&(this.wireframeLinecap=e.wireframeLinecap),e.wireframeLinejoin!==void 0&&(this.wireframeLinejoin=e.wireframeLinejoin),e.rotation!==void 0&&(this.rotation=e.rotation),e.linewidth!==void 0&&(this.linewidth=e.linewidth),e.linecap!==void 0&&(this.linecap=e.linecap),e.linejoin!==void 0&&(this.linejoin=e.linejoin),e.dashSize!==void 0&&(this.dashSize=e.dashSize),e.gapSize!==void 0&&(this.gapSize=e.gapSize),e.scale!==void 0&&(this.scale=e.scale),e.polygonOffset!==void 0&&(this.polygonOffset=e.polygonOffset),e.polygonOffsetFactor!==void 0&&(this.polygonOffsetFactor=e.polygonOffsetFactor),e.polygonOffsetUnits!==void 0&&(this.polygonOffsetUnits=e.polygonOffsetUnits),e.dithering!==void 0&&(this.dithering=e.dithering),e.alphaToCoverage!==void 0&&(this.alphaToCoverage=e.alphaToCoverage),e.premultipliedAlpha!==void 0&&(this.premultipliedAlpha=e.premultipliedAlpha),e.forceSinglePass!==void 0&&(this.forceSinglePass=e.forceSinglePass),e.allowOverride!==void 0&&(this.allowOverride=e.allowOverride),e.visible!==void 0&&(this.visible=e.visible),e.toneMapped!==void 0&&(this.toneMapped=e.toneMapped),e.userData!==void 0&&(this.userData=e.userData),e.vertexColors!==void 0&&(this.vertexColors=typeof e.vertexColors==`number`?e.vertexColors>0:e.vertexColors),e.size!==void 0&&(this.size=e.size),e.sizeAttenuation!==void 0&&(this.sizeAttenuation=e.sizeAttenuation),e.map!==void 0&&(this.map=t[e.map]||null),e.matcap!==void 0&&(this.matcap=t[e.matcap]||null),e.alphaMap!==void 0&&(this.alphaMap=t[e.alphaMap]||null),e.bumpMap!==void 0&&(this.bumpMap=t[e.bumpMap]||null),e.bumpScale!==void 0&&(this.bumpScale=e.bumpScale),e.normalMap!==void 0&&(this.normalMap=t[e.normalMap]||null),e.normalMapType!==void 0&&(this.normalMapType=e.normalMapType),e.normalScale!==void 0){let t=e.normalScale;Array.isArray(t)===!1&&(t=[t,t]),this.normalScale=new Z().fromArray(t)}return e.displacementMap!==void 0&&(this.displacementMap=t[e.displacementMap]||null),e.displacementScale!==void 0&&(this.displacementScale=e.displacementScale),e.displacementBias!==void 0&&(this.displacementBias=e.displacementBias),e.roughnessMap!==void 0&&(this.roughnessMap=t[e.roughnessMap]||null),e.metalnessMap!==void 0&&(this.metalnessMap=t[e.metalnessMap]||null),e.emissiveMap!==void 0&&(this.emissiveMap=t[e.emissiveMap]||null),e.emissiveIntensity!==void 0&&(this.emissiveIntensity=e.emissiveIntensity),e.specularMap!==void 0&&(this.specularMap=t[e.specularMap]||null),e.specularIntensityMap!==void 0&&(this.specularIntensityMap=t[e.specularIntensityMap]||null),e.specularColorMap!==void 0&&(this.specularColorMap=t[e.specularColorMap]||null),e.envMap!==void 0&&(this.envMap=t[e.envMap]||null),e.envMapRotation!==void 0&&this.envMapRotation.fromArray(e.envMapRotation),e.envMapIntensity!==void 0&&(this.envMapIntensity=e.envMapIntensity),e.reflectivity!==void 0&&(this.reflectivity=e.reflectivity),e.refractionRatio!==void 0&&(this.refractionRatio=e.refractionRatio),e.lightMap!==void 0&&(this.lightMap=t[e.lightMap]||null),e.lightMapIntensity!==void 0&&(this.lightMapIntensity=e.lightMapIntensity),e.aoMap!==void 0&&(this.aoMap=t[e.aoMap]||null),e.aoMapIntensity!==void 0&&(this.aoMapIntensity=e.aoMapIntensity),e.gradientMap!==void 0&&(this.gradientMap=t[e.gradientMap]||null),e.clearcoatMap!==void 0&&(this.clearcoatMap=t[e.clearcoatMap]||null),e.clearcoatRoughnessMap!==void 0&&(this.clearcoatRoughnessMap=t[e.clearcoatRoughnessMap]||null),e.clearcoatNormalMap!==void 0&&(this.clearcoatNormalMap=t[e.clearcoatNormalMap]||null),e.clearcoatNormalScale!==void 0&&(this.clearcoatNormalScale=new Z().fromArray(e.clearcoatNormalScale)),e.diffuseRoughnessMap!==void 0&&(this.diffuseRoughnessMap=t[e.diffuseRoughnessMap]||null),e.iridescenceMap!==void 0&&(this.iridescenceMap=t[e.iridescenceMap]||null),e.iridescenceThicknessMap!==void 0&&(this.iridescenceThicknessMap=t[e.iridescenceThicknessMap]||null),e.transmissionMap!==void 0&&(this.transmissionMap=t[e.transmissionMap]||null),e.thicknessMap!==void 0&&(this.thicknessMap=t[e.thicknessMap]||null),e.anisotropyMap!==void 0&&(this.anisotropyMap=t[e.anisotropyMap]||null),e.sheenColorMap!==void 0&&(this.sheenColorMap=t[e.sheenColorMap]||null),e.sheenRoughnessMap!==void 0&&(this.sheenRoughnessMap=t[e.sheenRoughnessMap]||null),this}clone(){return new this.constructor().copy(this)}copy(e){this.name=e.name,this.blending=e.blending,this.side=e.side,this.vertexColors=e.vertexColors,this.opacity=e.opacity,this.transparent=e.transparent,this.blendSrc=e.blendSrc,this.blendDst=e.blendDst,this.blendEquation=e.blendEquation,this.blendSrcAlpha=e.blendSrcAlpha,this.blendDstAlpha=e.blendDstAlpha,this.blendEquationAlpha=e.blendEquationAlpha,this.blendColor.copy(e.blendColor),this.blendAlpha=e.blendAlpha,this.depthFunc=e.depthFunc,this.depthTest=e.depthTest,this.depthWrite=e.depthWrite,this.stencilWriteMask=e.stencilWriteMask,this.stencilFunc=e.stencilFunc,this.stencilRef=e.stencilRef,this.stencilFuncMask=e.stencilFuncMask,this.stencilFail=e.stencilFail,this.stencilZFail=e.stencilZFail,this.stencilZPass=e.stencilZPass,this.stencilWrite=e.stencilWrite;let t=e.clippingPlanes,n=null;if(t!==null){let e=t.length;n=Array(e);for(let r=0;r!==e;++r)n[r]=t[r].clone()}return this.clippingPlanes=n,this.clipIntersection=e.clipIntersection,this.clipShadows=e.clipShadows,this.shadowSide=e.shadowSide,this.colorWrite=e.colorWrite,this.precision=e.precision,this.polygonOffset=e.polygonOffset,this.polygonOffsetFactor=e.polygonOffsetFactor,this.polygonOffsetUnits=e.polygonOffsetUnits,this.dithering=e.dithering,this.alphaTest=e.alphaTest,this.alphaHash=e.alphaHash,this.alphaToCoverage=e.alphaToCoverage,this.premultipliedAlpha=e.premultipliedAlpha,this.forceSinglePass=e.forceSinglePass,this.allowOverride=e.allowOverride,this.visible=e.visible,this.toneMapped=e.toneMapped,this.userData=JSON.parse(JSON.stringify(e.userData)),this}dispose(){this.dispatchEvent({type:`dispose`})}set needsUpdate(e){e===!0&&this.version++}},m_=class extends p_{constructor(e){super(),this.isSpriteMaterial=!0,this.type=`SpriteMaterial`,this.color=new sg(16777215),this.map=null,this.alphaMap=null,this.rotation=0,this.sizeAttenuation=!0,this.transparent=!0,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.alphaMap=e.alphaMap,this.rotation=e.rotation,this.sizeAttenuation=e.sizeAttenuation,this.fog=e.fog,this}},h_,g_=new Q,__=new Q,v_=new Q,y_=new Z,b_=new Z,x_=new Eh,S_=new Q,C_=new Q,w_=new Q,T_=new Z,E_=new Z,D_=new Z,O_=class extends $h{constructor(e=new m_){if(super(),this.isSprite=!0,this.type=`Sprite`,h_===void 0){h_=new r_;let e=new i_(new Float32Array([-.5,-.5,0,0,0,.5,-.5,0,1,0,.5,.5,0,1,1,-.5,.5,0,0,1]),5);h_.setIndex([0,1,2,0,2,3]),h_.setAttribute(`position`,new s_(e,3,0,!1)),h_.setAttribute(`uv`,new s_(e,2,3,!1))}this.geometry=h_,this.material=e,this.center=new Z(.5,.5),this.count=1}intersectsFrustum(e){return e.intersectsSprite(this)}raycast(e,t){e.camera===null&&Cm(`Sprite: "Raycaster.camera" needs to be set in order to raycast against sprites.`),__.setFromMatrixScale(this.matrixWorld),x_.copy(e.camera.matrixWorld),this.modelViewMatrix.multiplyMatrices(e.camera.matrixWorldInverse,this.matrixWorld),v_.setFromMatrixPosition(this.modelViewMatrix),e.camera.isPerspectiveCamera&&this.material.sizeAttenuation===!1&&__.multiplyScalar(-v_.z);let n=this.material.rotation,r,i;n!==0&&(i=Math.cos(n),r=Math.sin(n));let a=this.center;k_(S_.set(-.5,-.5,0),v_,a,__,r,i),k_(C_.set(.5,-.5,0),v_,a,__,r,i),k_(w_.set(.5,.5,0),v_,a,__,r,i),T_.set(0,0),E_.set(1,0),D_.set(1,1);let o=e.ray.intersectTriangle(S_,C_,w_,!1,g_);if(o===null&&(k_(C_.set(-.5,.5,0),v_,a,__,r,i),E_.set(0,1),o=e.ray.intersectTriangle(S_,w_,C_,!1,g_),o===null))return;let s=e.ray.origin.distanceTo(g_);s<e.near||s>e.far||t.push({distance:s,point:g_.clone(),uv:Cg.getInterpolation(g_,S_,C_,w_,T_,E_,D_,new Z),face:null,object:this})}copy(e,t){return super.copy(e,t),e.center!==void 0&&this.center.copy(e.center),this.material=e.material,this}toJSON(e){let t=super.toJSON(e);return t.object.center=this.center.toArray(),t}};function k_(e,t,n,r,i,a){y_.subVectors(e,n).addScalar(.5).multiply(r),i===void 0?b_.copy(y_):(b_.x=a*y_.x-i*y_.y,b_.y=i*y_.x+a*y_.y),e.copy(t),e.x+=b_.x,e.y+=b_.y,e.applyMatrix4(x_)}var A_=new Q,j_=new Q,M_=new Q,N_=new Q,P_=class{constructor(e=new Q,t=new Q(0,0,-1)){this.origin=e,this.direction=t}set(e,t){return this.origin.copy(e),this.direction.copy(t),this}copy(e){return this.origin.copy(e.origin),this.direction.copy(e.direction),this}at(e,t){return t.copy(this.origin).addScaledVector(this.direction,e)}lookAt(e){return this.direction.copy(e).sub(this.origin).normalize(),this}recast(e){return this.origin.copy(this.at(e,A_)),this}closestPointToPoint(e,t){t.subVectors(e,this.origin);let n=t.dot(this.direction);return n<0?t.copy(this.origin):t.copy(this.origin).addScaledVector(this.direction,n)}distanceToPoint(e){return Math.sqrt(this.distanceSqToPoint(e))}distanceSqToPoint(e){let t=A_.subVectors(e,this.origin).dot(this.direction);return t<0?this.origin.distanceToSquared(e):(A_.copy(this.origin).addScaledVector(this.direction,t),A_.distanceToSquared(e))}distanceSqToSegment(e,t,n,r){j_.copy(e).add(t).multiplyScalar(.5),M_.copy(t).sub(e).normalize(),N_.copy(this.origin).sub(j_);let i=e.distanceTo(t)*.5,a=-this.direction.dot(M_),o=N_.dot(this.direction),s=-N_.dot(M_),c=N_.lengthSq(),l=Math.abs(1-a*a),u,d,f,p;if(l>0){if(u=a*s-o,d=a*o-s,p=i*l,u>=0){if(d>=-p){if(d<=p){let e=1/l;u*=e,d*=e,f=u*(u+a*d+2*o)+d*(a*u+d+2*s)+c}else d=i,u=Math.max(0,-(a*d+o)),f=-u*u+d*(d+2*s)+c}else d=-i,u=Math.max(0,-(a*d+o)),f=-u*u+d*(d+2*s)+c}else d<=-p?(u=Math.max(0,-(-a*i+o)),d=u>0?-i:Math.min(Math.max(-i,-s),i),f=-u*u+d*(d+2*s)+c):d<=p?(u=0,d=Math.min(Math.max(-i,-s),i),f=d*(d+2*s)+c):(u=Math.max(0,-(a*i+o)),d=u>0?i:Math.min(Math.max(-i,-s),i),f=-u*u+d*(d+2*s)+c)}else d=a>0?-i:i,u=Math.max(0,-(a*d+o)),f=-u*u+d*(d+2*s)+c;return n&&n.copy(this.origin).addScaledVector(this.direction,u),r&&r.copy(j_).addScaledVector(M_,d),f}intersectSphere(e,t){if(e.radius<0)return null;A_.subVectors(e.center,this.origin);let n=A_.dot(this.direction),r=A_.dot(A_)-n*n,i=e.radius*e.radius;if(r>i)return null;let a=Math.sqrt(i-r),o=n-a,s=n+a;return s<0?null:o<0?this.at(s,t):this.at(o,t)}intersectsSphere(e){return e.radius<0?!1:this.distanceSqToPoint(e.center)<=e.radius*e.radius}distanceToPlane(e){let t=e.normal.dot(this.direction);if(t===0)return e.distanceToPoint(this.origin)===0?0:null;let n=-(this.origin.dot(e.normal)+e.constant)/t;return n>=0?n:null}intersectPlane(e,t){let n=this.distanceToPlane(e);return n===null?null:this.at(n,t)}intersectsPlane(e){let t=e.distanceToPoint(this.origin);return t===0||e.normal.dot(this.direction)*t<0}intersectBox(e,t){let n,r,i,a,o,s,c=1/this.direction.x,l=1/this.direction.y,u=1/this.direction.z,d=this.origin;return c>=0?(n=(e.min.x-d.x)*c,r=(e.max.x-d.x)*c):(n=(e.max.x-d.x)*c,r=(e.min.x-d.x)*c),l>=0?(i=(e.min.y-d.y)*l,a=(e.max.y-d.y)*l):(i=(e.max.y-d.y)*l,a=(e.min.y-d.y)*l),n>a||i>r||((i>n||isNaN(n))&&(n=i),(a<r||isNaN(r))&&(r=a),u>=0?(o=(e.min.z-d.z)*u,s=(e.max.z-d.z)*u):(o=(e.max.z-d.z)*u,s=(e.min.z-d.z)*u),n>s||o>r)||((o>n||n!==n)&&(n=o),(s<r||r!==r)&&(r=s),r<0)?null:this.at(n>=0?n:r,t)}intersectsBox(e){return this.intersectBox(e,A_)!==null}intersectTriangle(e,t,n,r,i){let a=this.origin,o=this.direction,s=o.x,c=o.y,l=o.z,u=e.x-a.x,d=e.y-a.y,f=e.z-a.z,p=t.x-a.x,m=t.y-a.y,h=t.z-a.z,g=n.x-a.x,_=n.y-a.y,v=n.z-a.z,y=Math.abs(s),b=Math.abs(c),x=Math.abs(l),S,C,w,T,E,D,O,ee,k,te,ne,re;if(y>=b&&y>=x?(w=s,D=u,k=p,re=g,s>=0?(S=c,C=l,T=d,E=f,O=m,ee=h,te=_,ne=v):(S=l,C=c,T=f,E=d,O=h,ee=m,te=v,ne=_)):b>=x?(w=c,D=d,k=m,re=_,c>=0?(S=l,C=s,T=f,E=u,O=h,ee=p,te=v,ne=g):(S=s,C=l,T=u,E=f,O=p,ee=h,te=g,ne=v)):(w=l,D=f,k=h,re=v,l>=0?(S=s,C=c,T=u,E=d,O=p,ee=m,te=g,ne=_):(S=c,C=s,T=d,E=u,O=m,ee=p,te=_,ne=g)),w===0)return null;let ie=S/w,ae=C/w,oe=1/w,se=T-ie*D,ce=E-ae*D,le=O-ie*k,ue=ee-ae*k,de=te-ie*re,fe=ne-ae*re,pe=de*ue-fe*le,me=se*fe-ce*de,he=le*ce-ue*se;if(r){if(pe<0||me<0||he<0)return null}else if((pe<0||me<0||he<0)&&(pe>0||me>0||he>0))return null;let ge=pe+me+he;if(ge===0)return null;let _e=oe*(pe*D+me*k+he*re);return(ge>0?_e<0:_e>0)?null:this.at(_e/ge,i)}applyMatrix4(e){return this.origin.applyMatrix4(e),this.direction.transformDirection(e),this}equals(e){return e.origin.equals(this.origin)&&e.direction.equals(this.direction)}clone(){return new this.constructor().copy(this)}},F_=class extends p_{constructor(e){super(),this.isMeshBasicMaterial=!0,this.type=`MeshBasicMaterial`,this.color=new sg(16777215),this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.specularMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new Ih,this.combine=0,this.reflectivity=1,this.refractionRatio=.98,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap=`round`,this.wireframeLinejoin=`round`,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.lightMap=e.lightMap,this.lightMapIntensity=e.lightMapIntensity,this.aoMap=e.aoMap,this.aoMapIntensity=e.aoMapIntensity,this.specularMap=e.specularMap,this.alphaMap=e.alphaMap,this.envMap=e.envMap,this.envMapRotation.copy(e.envMapRotation),this.combine=e.combine,this.reflectivity=e.reflectivity,this.refractionRatio=e.refractionRatio,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.wireframeLinecap=e.wireframeLinecap,this.wireframeLinejoin=e.wireframeLinejoin,this.fog=e.fog,this}},I_=new Eh,L_=new P_,R_=new Yg,z_=new Q,B_=new Q,V_=new Q,H_=new Q,U_=new Q,W_=new Q,G_=new Q,K_=new Q,q_=class extends $h{constructor(e=new r_,t=new F_){super(),this.isMesh=!0,this.type=`Mesh`,this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.count=1,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),this.morphTargetInfluences=e.morphTargetInfluences===void 0?void 0:e.morphTargetInfluences.slice(),this.morphTargetDictionary=e.morphTargetDictionary===void 0?void 0:Object.assign({},e.morphTargetDictionary),this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}updateMorphTargets(){let e=this.geometry.morphAttributes,t=Object.keys(e);if(t.length>0){let n=e[t[0]];if(n!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let e=0,t=n.length;e<t;e++){let t=n[e].name||String(e);this.morphTargetInfluences.push(0),this.morphTargetDictionary[t]=e}}}}getVertexPosition(e,t){let n=this.geometry,r=n.attributes.position,i=n.morphAttributes.position,a=n.morphTargetsRelative;t.fromBufferAttribute(r,e);let o=this.morphTargetInfluences;if(i&&o){W_.set(0,0,0);for(let n=0,r=i.length;n<r;n++){let r=o[n],s=i[n];r!==0&&(U_.fromBufferAttribute(s,e),a?W_.addScaledVector(U_,r):W_.addScaledVector(U_.sub(t),r))}t.add(W_)}return t}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let n=this.geometry,r=this.material,i=this.matrixWorld;r!==void 0&&(n.boundingSphere===null&&n.computeBoundingSphere(),R_.copy(n.boundingSphere),R_.applyMatrix4(i),L_.copy(e.ray).recast(e.near),R_.containsPoint(L_.origin)===!1&&(L_.intersectSphere(R_,z_)===null||L_.origin.distanceToSquared(z_)>(e.far-e.near)**2)||(I_.copy(i).invert(),L_.copy(e.ray).applyMatrix4(I_),(n.boundingBox===null||L_.intersectsBox(n.boundingBox)!==!1)&&this._computeIntersections(e,t,L_)))}_computeIntersections(e,t,n){let r,i=this.geometry,a=this.material,o=i.index,s=i.attributes.position,c=i.attributes.uv,l=i.attributes.uv1,u=i.attributes.normal,d=i.groups,f=i.drawRange;if(o!==null){if(Array.isArray(a))for(let i=0,s=d.length;i<s;i++){let s=d[i],p=a[s.materialIndex],m=Math.max(s.start,f.start),h=Math.min(o.count,Math.min(s.start+s.count,f.start+f.count));for(let i=m,a=h;i<a;i+=3){let a=o.getX(i),d=o.getX(i+1),f=o.getX(i+2);r=Y_(this,p,e,n,c,l,u,a,d,f),r&&(r.faceIndex=Math.floor(i/3),r.face.materialIndex=s.materialIndex,t.push(r))}}else{let i=Math.max(0,f.start),s=Math.min(o.count,f.start+f.count);for(let d=i,f=s;d<f;d+=3){let i=o.getX(d),s=o.getX(d+1),f=o.getX(d+2);r=Y_(this,a,e,n,c,l,u,i,s,f),r&&(r.faceIndex=Math.floor(d/3),t.push(r))}}}else if(s!==void 0){if(Array.isArray(a))for(let i=0,o=d.length;i<o;i++){let o=d[i],p=a[o.materialIndex],m=Math.max(o.start,f.start),h=Math.min(s.count,Math.min(o.start+o.count,f.start+f.count));for(let i=m,a=h;i<a;i+=3){let a=i,s=i+1,d=i+2;r=Y_(this,p,e,n,c,l,u,a,s,d),r&&(r.faceIndex=Math.floor(i/3),r.face.materialIndex=o.materialIndex,t.push(r))}}else{let i=Math.max(0,f.start),o=Math.min(s.count,f.start+f.count);for(let s=i,d=o;s<d;s+=3){let i=s,o=s+1,d=s+2;r=Y_(this,a,e,n,c,l,u,i,o,d),r&&(r.faceIndex=Math.floor(s/3),t.push(r))}}}}};function J_(e,t,n,r,i,a,o,s){let c;if(c=t.side===1?r.intersectTriangle(o,a,i,!0,s):r.intersectTriangle(i,a,o,t.side===0,s),c===null)return null;K_.copy(s),K_.applyMatrix4(e.matrixWorld);let l=n.ray.origin.distanceTo(K_);return l<n.near||l>n.far?null:{distance:l,point:K_.clone(),object:e}}function Y_(e,t,n,r,i,a,o,s,c,l){e.getVertexPosition(s,B_),e.getVertexPosition(c,V_),e.getVertexPosition(l,H_);let u=J_(e,t,n,r,B_,V_,H_,G_);if(u){let e=new Q;Cg.getBarycoord(G_,B_,V_,H_,e),i&&(u.uv=Cg.getInterpolatedAttribute(i,s,c,l,e,new Z)),a&&(u.uv1=Cg.getInterpolatedAttribute(a,s,c,l,e,new Z)),o&&(u.normal=Cg.getInterpolatedAttribute(o,s,c,l,e,new Q),u.normal.dot(r.direction)>0&&u.normal.multiplyScalar(-1));let t={a:s,b:c,c:l,normal:new Q,materialIndex:0};Cg.getNormal(B_,V_,H_,t.normal),u.face=t,u.barycoord=e}return u}var X_=class extends bh{constructor(e=null,t=1,n=1,r,i,a,o,s,c=Uf,l=Uf,u,d){super(null,a,o,s,c,l,r,i,u,d),this.isDataTexture=!0,this.image={data:e,width:t,height:n},this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}},Z_=new Yg,Q_=new Z(.5,.5),$_=new Q,ev=class{constructor(e=new d_,t=new d_,n=new d_,r=new d_,i=new d_,a=new d_){this.planes=[e,t,n,r,i,a]}set(e,t,n,r,i,a){let o=this.planes;return o[0].copy(e),o[1].copy(t),o[2].copy(n),o[3].copy(r),o[4].copy(i),o[5].copy(a),this}copy(e){let t=this.planes;for(let n=0;n<6;n++)t[n].copy(e.planes[n]);return this}setFromProjectionMatrix(e,t=mm,n=!1){let r=this.planes,i=e.elements,a=i[0],o=i[1],s=i[2],c=i[3],l=i[4],u=i[5],d=i[6],f=i[7],p=i[8],m=i[9],h=i[10],g=i[11],_=i[12],v=i[13],y=i[14],b=i[15];if(r[0].setComponents(c-a,f-l,g-p,b-_).normalize(),r[1].setComponents(c+a,f+l,g+p,b+_).normalize(),r[2].setComponents(c+o,f+u,g+m,b+v).normalize(),r[3].setComponents(c-o,f-u,g-m,b-v).normalize(),n)r[4].setComponents(s,d,h,y).normalize(),r[5].setComponents(c-s,f-d,g-h,b-y).normalize();else if(r[4].setComponents(c-s,f-d,g-h,b-y).normalize(),t===2e3)r[5].setComponents(c+s,f+d,g+h,b+y).normalize();else if(t===2001)r[5].setComponents(s,d,h,y).normalize();else throw Error(`THREE.Frustum.setFromProjectionMatrix(): Invalid coordinate system: `+t);return this}intersectsObject(e){if(e.boundingSphere!==void 0)e.boundingSphere===null&&e.computeBoundingSphere(),Z_.copy(e.boundingSphere).applyMatrix4(e.matrixWorld);else{let t=e.geometry;t.boundingSphere===null&&t.computeBoundingSphere(),Z_.copy(t.boundingSphere).applyMatrix4(e.matrixWorld)}return this.intersectsSphere(Z_)}intersectsSprite(e){return Z_.center.set(0,0,0),Z_.radius=.7071067811865476+Q_.distanceTo(e.center),Z_.applyMatrix4(e.matrixWorld),this.intersectsSphere(Z_)}intersectsSphere(e){let t=this.planes,n=e.center,r=-e.radius;for(let e=0;e<6;e++)if(t[e].distanceToPoint(n)<r)return!1;return!0}intersectsBox(e){let t=this.planes;for(let n=0;n<6;n++){let r=t[n];if($_.x=r.normal.x>0?e.max.x:e.min.x,$_.y=r.normal.y>0?e.max.y:e.min.y,$_.z=r.normal.z>0?e.max.z:e.min.z,r.distanceToPoint($_)<0)return!1}return!0}containsPoint(e){let t=this.planes;for(let n=0;n<6;n++)if(t[n].distanceToPoint(e)<0)return!1;return!0}clone(){return new this.constructor().copy(this)}},tv=new Eh,nv=class e{constructor(){this.coordinateSystem=mm,this._frustums=[],this._count=0}setFromArrayCamera(e){let t=e.cameras,n=this._frustums;for(let e=0;e<t.length;e++){let r=t[e];tv.multiplyMatrices(r.projectionMatrix,r.matrixWorldInverse),n[e]===void 0&&(n[e]=new ev),n[e].setFromProjectionMatrix(tv,r.coordinateSystem,r.reversedDepth)}return this._count=t.length,this}getFrustum(e){return this._frustums[e]}intersectsObject(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsObject(e))return!0;return!1}intersectsSprite(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsSprite(e))return!0;return!1}intersectsSphere(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsSphere(e))return!0;return!1}intersectsBox(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].intersectsBox(e))return!0;return!1}containsPoint(e){let t=this._frustums;for(let n=0;n<this._count;n++)if(t[n].containsPoint(e))return!0;return!1}copy(e){this.coordinateSystem=e.coordinateSystem;let t=this._frustums,n=e._frustums;for(let r=0;r<e._count;r++)t[r]===void 0&&(t[r]=new ev),t[r].copy(n[r]);return this._count=e._count,this}clone(){return new e().copy(this)}},rv=class extends p_{constructor(e){super(),this.isLineBasicMaterial=!0,this.type=`LineBasicMaterial`,this.color=new sg(16777215),this.map=null,this.linewidth=1,this.linecap=`round`,this.linejoin=`round`,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.color.copy(e.color),this.map=e.map,this.linewidth=e.linewidth,this.linecap=e.linecap,this.linejoin=e.linejoin,this.fog=e.fog,this}},iv=new Q,av=new Q,ov=new Eh,sv=new P_,cv=new Yg,lv=new Q,uv=new Q,dv=class extends $h{constructor(e=new r_,t=new rv){super(),this.isLine=!0,this.type=`Line`,this.geometry=e,this.material=t,this.morphTargetDictionary=void 0,this.morphTargetInfluences=void 0,this.updateMorphTargets()}copy(e,t){return super.copy(e,t),this.morphTargetInfluences=e.morphTargetInfluences===void 0?void 0:e.morphTargetInfluences.slice(),this.morphTargetDictionary=e.morphTargetDictionary===void 0?void 0:Object.assign({},e.morphTargetDictionary),this.material=Array.isArray(e.material)?e.material.slice():e.material,this.geometry=e.geometry,this}computeLineDistances(){let e=this.geometry;if(e.index===null){let t=e.attributes.position,n=[0];for(let e=1,r=t.count;e<r;e++)iv.fromBufferAttribute(t,e-1),av.fromBufferAttribute(t,e),n[e]=n[e-1],n[e]+=iv.distanceTo(av);e.setAttribute(`lineDistance`,new Gg(n,1))}else Sm(`Line.computeLineDistances(): Computation only possible with non-indexed BufferGeometry.`);return this}intersectsFrustum(e){return e.intersectsObject(this)}raycast(e,t){let n=this.geometry,r=this.matrixWorld,i=e.params.Line.threshold,a=n.drawRange;if(n.boundingSphere===null&&n.computeBoundingSphere(),cv.copy(n.boundingSphere),cv.applyMatrix4(r),cv.radius+=i,e.ray.intersectsSphere(cv)===!1)return;ov.copy(r).invert(),sv.copy(e.ray).applyMatrix4(ov);let o=i/((this.scale.x+this.scale.y+this.scale.z)/3),s=o*o,c=this.isLineSegments?2:1,l=n.index,u=n.attributes.position;if(l!==null){let n=Math.max(0,a.start),r=Math.min(l.count,a.start+a.count);for(let i=n,a=r-1;i<a;i+=c){let n=l.getX(i),r=l.getX(i+1),a=fv(this,e,sv,s,n,r,i);a&&t.push(a)}if(this.isLineLoop){let i=l.getX(r-1),a=l.getX(n),o=fv(this,e,sv,s,i,a,r-1);o&&t.push(o)}}else{let n=Math.max(0,a.start),r=Math.min(u.count,a.start+a.count);for(let i=n,a=r-1;i<a;i+=c){let n=fv(this,e,sv,s,i,i+1,i);n&&t.push(n)}if(this.isLineLoop){let i=fv(this,e,sv,s,r-1,n,r-1);i&&t.push(i)}}}updateMorphTargets(){let e=this.geometry.morphAttributes,t=Object.keys(e);if(t.length>0){let n=e[t[0]];if(n!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let e=0,t=n.length;e<t;e++){let t=n[e].name||String(e);this.morphTargetInfluences.push(0),this.morphTargetDictionary[t]=e}}}}};function fv(e,t,n,r,i,a,o){let s=e.geometry.attributes.position;if(iv.fromBufferAttribute(s,i),av.fromBufferAttribute(s,a),n.distanceSqToSegment(iv,av,lv,uv)>r)return;lv.applyMatrix4(e.matrixWorld);let c=t.ray.origin.distanceTo(lv);if(!(c<t.near||c>t.far))return{distance:c,point:uv.clone().applyMatrix4(e.matrixWorld),index:o,face:null,faceIndex:null,barycoord:null,object:e}}var pv=class extends bh{constructor(e=[],t=301,n,r,i,a,o,s,c,l){super(e,t,n,r,i,a,o,s,c,l),this.isCubeTexture=!0,this.flipY=!1}get images(){return this.image}set images(e){this.image=e}},mv=class extends bh{constructor(e,t,n,r,i,a,o,s,c){super(e,t,n,r,i,a,o,s,c),this.isCanvasTexture=!0,this.needsUpdate=!0}},hv=class extends bh{constructor(e,t,n=ep,r,i,a,o=Uf,s=Uf,c,l=dp,u=1){if(l!==1026&&l!==1027)throw Error(`THREE.DepthTexture: format must be either THREE.DepthFormat or THREE.DepthStencilFormat`);super({width:e,height:t,depth:u},r,i,a,o,s,l,n,c),this.isDepthTexture=!0,this.flipY=!1,this.generateMipmaps=!1,this.compareFunction=null}copy(e){return super.copy(e),this.source=new gh(Object.assign({},e.image)),this.compareFunction=e.compareFunction,this}toJSON(e){let t=super.toJSON(e);return t.compareFunction=this.compareFunction,t}},gv=class extends hv{constructor(e,t=ep,n=301,r,i,a=Uf,o=Uf,s,c=dp){let l={width:e,height:e,depth:1},u=[l,l,l,l,l,l];super(e,e,t,n,r,i,a,o,s,c),this.image=u,this.isCubeDepthTexture=!0,this.isCubeTexture=!0}get images(){return this.image}set images(e){this.image=e}},_v=class extends bh{constructor(e=null){super(),this.sourceTexture=e,this.isExternalTexture=!0}copy(e){return super.copy(e),this.sourceTexture=e.sourceTexture,this}},vv=class e extends r_{constructor(e=1,t=1,n=1,r=1,i=1,a=1){super(),this.type=`BoxGeometry`,this.parameters={width:e,height:t,depth:n,widthSegments:r,heightSegments:i,depthSegments:a};let o=this;r=Math.floor(r),i=Math.floor(i),a=Math.floor(a);let s=[],c=[],l=[],u=[],d=0,f=0;p(`z`,`y`,`x`,-1,-1,n,t,e,a,i,0),p(`z`,`y`,`x`,1,-1,n,t,-e,a,i,1),p(`x`,`z`,`y`,1,1,e,n,t,r,a,2),p(`x`,`z`,`y`,1,-1,e,n,-t,r,a,3),p(`x`,`y`,`z`,1,-1,e,t,n,r,i,4),p(`x`,`y`,`z`,-1,-1,e,t,-n,r,i,5),this.setIndex(s),this.setAttribute(`position`,new Gg(c,3)),this.setAttribute(`normal`,new Gg(l,3)),this.setAttribute(`uv`,new Gg(u,2));function p(e,t,n,r,i,a,p,m,h,g,_){let v=a/h,y=p/g,b=a/2,x=p/2,S=m/2,C=h+1,w=g+1,T=0,E=0,D=new Q;for(let a=0;a<w;a++){let o=a*y-x;for(let s=0;s<C;s++)D[e]=(s*v-b)*r,D[t]=o*i,D[n]=S,c.push(D.x,D.y,D.z),D[e]=0,D[t]=0,D[n]=m>0?1:-1,l.push(D.x,D.y,D.z),u.push(s/h),u.push(1-a/g),T+=1}for(let e=0;e<g;e++)for(let t=0;t<h;t++){let n=d+t+C*e,r=d+t+C*(e+1),i=d+(t+1)+C*(e+1),a=d+(t+1)+C*e;s.push(n,r,a),s.push(r,i,a),E+=6}o.addGroup(f,E,_),f+=E,d+=T}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(t){return new e(t.width,t.height,t.depth,t.widthSegments,t.heightSegments,t.depthSegments)}},yv=class e extends r_{constructor(e=1,t=1,n=4,r=8,i=1){super(),this.type=`CapsuleGeometry`,this.parameters={radius:e,height:t,capSegments:n,radialSegments:r,heightSegments:i},t=Math.max(0,t),n=Math.max(1,Math.floor(n)),r=Math.max(3,Math.floor(r)),i=Math.max(1,Math.floor(i));let a=[],o=[],s=[],c=[],l=t/2,u=Math.PI/2*e,d=t,f=2*u+d,p=n*2+i,m=r+1,h=new Q,g=new Q;for(let _=0;_<=p;_++){let v=0,y=0,b=0,x=0;if(_<=n){let t=_/n,r=t*Math.PI/2;y=-l-e*Math.cos(r),b=e*Math.sin(r),x=-e*Math.cos(r),v=t*u}else if(_<=n+i){let r=(_-n)/i;y=-l+r*t,b=e,x=0,v=u+r*d}else{let t=(_-n-i)/n,r=t*Math.PI/2;y=l+e*Math.sin(r),b=e*Math.cos(r),x=e*Math.sin(r),v=u+d+t*u}let S=Math.max(0,Math.min(1,v/f)),C=0;_===0?C=.5/r:_===p&&(C=-.5/r);for(let e=0;e<=r;e++){let t=e/r,n=t*Math.PI*2,i=Math.sin(n),a=Math.cos(n);g.x=-b*a,g.y=y,g.z=b*i,o.push(g.x,g.y,g.z),h.set(-b*a,x,b*i),h.normalize(),s.push(h.x,h.y,h.z),c.push(t+C,S)}if(_>0){let e=(_-1)*m;for(let t=0;t<r;t++){let n=e+t,r=e+t+1,i=_*m+t,o=_*m+t+1;a.push(n,r,i),a.push(r,o,i)}}}this.setIndex(a),this.setAttribute(`position`,new Gg(o,3)),this.setAttribute(`normal`,new Gg(s,3)),this.setAttribute(`uv`,new Gg(c,2))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(t){return new e(t.radius,t.height,t.capSegments,t.radialSegments,t.heightSegments)}},bv=class e extends r_{constructor(e=1,t=1,n=1,r=32,i=1,a=!1,o=0,s=Math.PI*2){super(),this.type=`CylinderGeometry`,this.parameters={radiusTop:e,radiusBottom:t,height:n,radialSegments:r,heightSegments:i,openEnded:a,thetaStart:o,thetaLength:s};let c=this;r=Math.floor(r),i=Math.floor(i);let l=[],u=[],d=[],f=[],p=0,m=[],h=n/2,g=0;_(),a===!1&&(e>0&&v(!0),t>0&&v(!1)),this.setIndex(l),this.setAttribute(`position`,new Gg(u,3)),this.setAttribute(`normal`,new Gg(d,3)),this.setAttribute(`uv`,new Gg(f,2));function _(){let a=new Q,_=new Q,v=0,y=(t-e)/n;for(let c=0;c<=i;c++){let l=[],g=c/i,v=g*(t-e)+e;for(let e=0;e<=r;e++){let t=e/r,i=t*s+o,c=Math.sin(i),m=Math.cos(i);_.x=v*c,_.y=-g*n+h,_.z=v*m,u.push(_.x,_.y,_.z),a.set(c,y,m).normalize(),d.push(a.x,a.y,a.z),f.push(t,1-g),l.push(p++)}m.push(l)}for(let n=0;n<r;n++)for(let r=0;r<i;r++){let a=m[r][n],o=m[r+1][n],s=m[r+1][n+1],c=m[r][n+1];(e>0||r!==0)&&(l.push(a,o,c),v+=3),(t>0||r!==i-1)&&(l.push(o,s,c),v+=3)}c.addGroup(g,v,0),g+=v}function v(n){let i=p,a=new Z,m=new Q,_=0,v=n===!0?e:t,y=n===!0?1:-1;for(let e=1;e<=r;e++)u.push(0,h*y,0),d.push(0,y,0),f.push(.5,.5),p++;let b=p;for(let e=0;e<=r;e++){let t=e/r*s+o,n=Math.cos(t),i=Math.sin(t);m.x=v*i,m.y=h*y,m.z=v*n,u.push(m.x,m.y,m.z),d.push(0,y,0),a.x=n*.5+.5,a.y=i*.5*y+.5,f.push(a.x,a.y),p++}for(let e=0;e<r;e++){let t=i+e,r=b+e;n===!0?l.push(r,r+1,t):l.push(r+1,r,t),_+=3}c.addGroup(g,_,n===!0?1:2),g+=_}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(t){return new e(t.radiusTop,t.radiusBottom,t.height,t.radialSegments,t.heightSegments,t.openEnded,t.thetaStart,t.thetaLength)}},xv=class{constructor(){this.type=`Curve`,this.arcLengthDivisions=200,this.needsUpdate=!1,this.cacheArcLengths=null}getPoint(){Sm(`Curve: .getPoint() not implemented.`)}getPointAt(e,t){let n=this.getUtoTmapping(e);return this.getPoint(n,t)}getPoints(e=5){let t=[];for(let n=0;n<=e;n++)t.push(this.getPoint(n/e));return t}getSpacedPoints(e=5){let t=[];for(let n=0;n<=e;n++)t.push(this.getPointAt(n/e));return t}getLength(){let e=this.getLengths();return e[e.length-1]}getLengths(e=this.arcLengthDivisions){if(this.cacheArcLengths&&this.cacheArcLengths.length===e+1&&!this.needsUpdate)return this.cacheArcLengths;this.needsUpdate=!1;let t=[],n,r=this.getPoint(0),i=0;t.push(0);for(let a=1;a<=e;a++)n=this.getPoint(a/e),i+=n.distanceTo(r),t.push(i),r=n;return this.cacheArcLengths=t,t}updateArcLengths(){this.needsUpdate=!0,this.getLengths()}getUtoTmapping(e,t=null){let n=this.getLengths(),r=0,i=n.length,a;a=t||e*n[i-1];let o=0,s=i-1,c;for(;o<=s;)if(r=Math.floor(o+(s-o)/2),c=n[r]-a,c<0)o=r+1;else if(c>0)s=r-1;else{s=r;break}if(r=s,n[r]===a)return r/(i-1);let l=n[r],u=n[r+1]-l,d=(a-l)/u;return(r+d)/(i-1)}getTangent(e,t){let n=1e-4,r=e-n,i=e+n;r<0&&(r=0),i>1&&(i=1);let a=this.getPoint(r),o=this.getPoint(i),s=t||(a.isVector2?new Z:new Q);return s.copy(o).sub(a).normalize(),s}getTangentAt(e,t){let n=this.getUtoTmapping(e);return this.getTangent(n,t)}computeFrenetFrames(e,t=!1){let n=new Q,r=[],i=[],a=[],o=new Q,s=new Eh;for(let t=0;t<=e;t++){let n=t/e;r[t]=this.getTangentAt(n,new Q)}i[0]=new Q,a[0]=new Q;let c=Number.MAX_VALUE,l=Math.abs(r[0].x),u=Math.abs(r[0].y),d=Math.abs(r[0].z);l<=c&&(c=l,n.set(1,0,0)),u<=c&&(c=u,n.set(0,1,0)),d<=c&&n.set(0,0,1),o.crossVectors(r[0],n).normalize(),i[0].crossVectors(r[0],o),a[0].crossVectors(r[0],i[0]);for(let t=1;t<=e;t++){if(i[t]=i[t-1].clone(),a[t]=a[t-1].clone(),o.crossVectors(r[t-1],r[t]),o.length()>2**-52){o.normalize();let e=Math.acos(Nm(r[t-1].dot(r[t]),-1,1));i[t].applyMatrix4(s.makeRotationAxis(o,e))}a[t].crossVectors(r[t],i[t])}if(t===!0){let t=Math.acos(Nm(i[0].dot(i[e]),-1,1));t/=e,r[0].dot(o.crossVectors(i[0],i[e]))>0&&(t=-t);for(let n=1;n<=e;n++)i[n].applyMatrix4(s.makeRotationAxis(r[n],t*n)),a[n].crossVectors(r[n],i[n])}return{tangents:r,normals:i,binormals:a}}clone(){return new this.constructor().copy(this)}copy(e){return this.arcLengthDivisions=e.arcLengthDivisions,this.cacheArcLengths=null,this}toJSON(){let e={metadata:{version:4.7,type:`Curve`,generator:`Curve.toJSON`}};return e.arcLengthDivisions=this.arcLengthDivisions,e.type=this.type,e}fromJSON(e){return this.arcLengthDivisions=e.arcLengthDivisions,this.cacheArcLengths=null,this}},Sv=class extends xv{constructor(e=0,t=0,n=1,r=1,i=0,a=Math.PI*2,o=!1,s=0){super(),this.isEllipseCurve=!0,this.type=`EllipseCurve`,this.aX=e,this.aY=t,this.xRadius=n,this.yRadius=r,this.aStartAngle=i,this.aEndAngle=a,this.aClockwise=o,this.aRotation=s}getPoint(e,t=new Z){let n=t,r=Math.PI*2,i=this.aEndAngle-this.aStartAngle,a=Math.abs(i)<2**-52;for(;i<0;)i+=r;for(;i>r;)i-=r;i<2**-52&&(i=a?0:r),this.aClockwise===!0&&!a&&(i===r?i=-r:i-=r);let o=this.aStartAngle+e*i,s=this.aX+this.xRadius*Math.cos(o),c=this.aY+this.yRadius*Math.sin(o);if(this.aRotation!==0){let e=Math.cos(this.aRotation),t=Math.sin(this.aRotation),n=s-this.aX,r=c-this.aY;s=n*e-r*t+this.aX,c=n*t+r*e+this.aY}return n.set(s,c)}copy(e){return super.copy(e),this.aX=e.aX,this.aY=e.aY,this.xRadius=e.xRadius,this.yRadius=e.yRadius,this.aStartAngle=e.aStartAngle,this.aEndAngle=e.aEndAngle,this.aClockwise=e.aClockwise,this.aRotation=e.aRotation,this}toJSON(){let e=super.toJSON();return e.aX=this.aX,e.aY=this.aY,e.xRadius=this.xRadius,e.yRadius=this.yRadius,e.aStartAngle=this.aStartAngle,e.aEndAngle=this.aEndAngle,e.aClockwise=this.aClockwise,e.aRotation=this.aRotation,e}fromJSON(e){return super.fromJSON(e),this.aX=e.aX,this.aY=e.aY,this.xRadius=e.xRadius,this.yRadius=e.yRadius,this.aStartAngle=e.aStartAngle,this.aEndAngle=e.aEndAngle,this.aClockwise=e.aClockwise,this.aRotation=e.aRotation,this}},Cv=class extends Sv{constructor(e,t,n,r,i,a){super(e,t,n,n,r,i,a),this.isArcCurve=!0,this.type=`ArcCurve`}};function wv(){let e=0,t=0,n=0,r=0;function i(i,a,o,s){e=i,t=o,n=-3*i+3*a-2*o-s,r=2*i-2*a+o+s}return{initCatmullRom:function(e,t,n,r,a){i(t,n,a*(n-e),a*(r-t))},initNonuniformCatmullRom:function(e,t,n,r,a,o,s){let c=(t-e)/a-(n-e)/(a+o)+(n-t)/o,l=(n-t)/o-(r-t)/(o+s)+(r-n)/s;c*=o,l*=o,i(t,n,c,l)},calc:function(i){let a=i*i,o=a*i;return e+t*i+n*a+r*o}}}var Tv=new Q,Ev=new Q,Dv=new wv,Ov=new wv,kv=new wv,Av=class extends xv{constructor(e=[],t=!1,n=`centripetal`,r=.5){super(),this.isCatmullRomCurve3=!0,this.type=`CatmullRomCurve3`,this.points=e,this.closed=t,this.curveType=n,this.tension=r}getPoint(e,t=new Q){let n=t,r=this.points,i=r.length,a=(i-+!this.closed)*e,o=Math.floor(a),s=a-o;this.closed?o+=o>0?0:(Math.floor(Math.abs(o)/i)+1)*i:s===0&&o===i-1&&(o=i-2,s=1);let c,l;this.closed||o>0?c=r[(o-1)%i]:(Ev.subVectors(r[0],r[1]).add(r[0]),c=Ev);let u=r[o%i],d=r[(o+1)%i];if(this.closed||o+2<i?l=r[(o+2)%i]:(Tv.subVectors(r[i-1],r[i-2]).add(r[i-1]),l=Tv),this.curveType===`centripetal`||this.curveType===`chordal`){let e=this.curveType===`chordal`?.5:.25,t=c.distanceToSquared(u)**+e,n=u.distanceToSquared(d)**+e,r=d.distanceToSquared(l)**+e;n<1e-4&&(n=1),t<1e-4&&(t=n),r<1e-4&&(r=n),Dv.initNonuniformCatmullRom(c.x,u.x,d.x,l.x,t,n,r),Ov.initNonuniformCatmullRom(c.y,u.y,d.y,l.y,t,n,r),kv.initNonuniformCatmullRom(c.z,u.z,d.z,l.z,t,n,r)}else this.curveType===`catmullrom`&&(Dv.initCatmullRom(c.x,u.x,d.x,l.x,this.tension),Ov.initCatmullRom(c.y,u.y,d.y,l.y,this.tension),kv.initCatmullRom(c.z,u.z,d.z,l.z,this.tension));return n.set(Dv.calc(s),Ov.calc(s),kv.calc(s)),n}copy(e){super.copy(e),this.points=[];for(let t=0,n=e.points.length;t<n;t++){let n=e.points[t];this.points.push(n.clone())}return this.closed=e.closed,this.curveType=e.curveType,this.tension=e.tension,this}toJSON(){let e=super.toJSON();e.points=[];for(let t=0,n=this.points.length;t<n;t++){let n=this.points[t];e.points.push(n.toArray())}return e.closed=this.closed,e.curveType=this.curveType,e.tension=this.tension,e}fromJSON(e){super.fromJSON(e),this.points=[];for(let t=0,n=e.points.length;t<n;t++){let n=e.points[t];this.points.push(new Q().fromArray(n))}return this.closed=e.closed,this.curveType=e.curveType,this.tension=e.tension,this}};function jv(e,t,n,r,i){let a=(r-t)*.5,o=(i-n)*.5,s=e*e,c=e*s;return(2*n-2*r+a+o)*c+(-3*n+3*r-2*a-o)*s+a*e+n}function Mv(e,t){let n=1-e;return n*n*t}function Nv(e,t){return 2*(1-e)*e*t}function Pv(e,t){return e*e*t}function Fv(e,t,n,r){return Mv(e,t)+Nv(e,n)+Pv(e,r)}function Iv(e,t){let n=1-e;return n*n*n*t}function Lv(e,t){let n=1-e;return 3*n*n*e*t}function Rv(e,t){return 3*(1-e)*e*e*t}function zv(e,t){return e*e*e*t}function Bv(e,t,n,r,i){return Iv(e,t)+Lv(e,n)+Rv(e,r)+zv(e,i)}var Vv=class extends xv{constructor(e=new Z,t=new Z,n=new Z,r=new Z){super(),this.isCubicBezierCurve=!0,this.type=`CubicBezierCurve`,this.v0=e,this.v1=t,this.v2=n,this.v3=r}getPoint(e,t=new Z){let n=t,r=this.v0,i=this.v1,a=this.v2,o=this.v3;return n.set(Bv(e,r.x,i.x,a.x,o.x),Bv(e,r.y,i.y,a.y,o.y)),n}copy(e){return super.copy(e),this.v0.copy(e.v0),this.v1.copy(e.v1),this.v2.copy(e.v2),this.v3.copy(e.v3),this}toJSON(){let e=super.toJSON();return e.v0=this.v0.toArray(),e.v1=this.v1.toArray(),e.v2=this.v2.toArray(),e.v3=this.v3.toArray(),e}fromJSON(e){return super.fromJSON(e),this.v0.fromArray(e.v0),this.v1.fromArray(e.v1),this.v2.fromArray(e.v2),this.v3.fromArray(e.v3),this}},Hv=class extends xv{constructor(e=new Q,t=new Q,n=new Q,r=new Q){super(),this.isCubicBezierCurve3=!0,this.type=`CubicBezierCurve3`,this.v0=e,this.v1=t,this.v2=n,this.v3=r}getPoint(e,t=new Q){let n=t,r=this.v0,i=this.v1,a=this.v2,o=this.v3;return n.set(Bv(e,r.x,i.x,a.x,o.x),Bv(e,r.y,i.y,a.y,o.y),Bv(e,r.z,i.z,a.z,o.z)),n}copy(e){return super.copy(e),this.v0.copy(e.v0),this.v1.copy(e.v1),this.v2.copy(e.v2),this.v3.copy(e.v3),this}toJSON(){let e=super.toJSON();return e.v0=this.v0.toArray(),e.v1=this.v1.toArray(),e.v2=this.v2.toArray(),e.v3=this.v3.toArray(),e}fromJSON(e){return super.fromJSON(e),this.v0.fromArray(e.v0),this.v1.fromArray(e.v1),this.v2.fromArray(e.v2),this.v3.fromArray(e.v3),this}},Uv=class extends xv{constructor(e=new Z,t=new Z){super(),this.isLineCurve=!0,this.type=`LineCurve`,this.v1=e,this.v2=t}getPoint(e,t=new Z){let n=t;return e===1?n.copy(this.v2):(n.copy(this.v2).sub(this.v1),n.multiplyScalar(e).add(this.v1)),n}getPointAt(e,t){return this.getPoint(e,t)}getTangent(e,t=new Z){return t.subVectors(this.v2,this.v1).normalize()}getTangentAt(e,t){return this.getTangent(e,t)}copy(e){return super.copy(e),this.v1.copy(e.v1),this.v2.copy(e.v2),this}toJSON(){let e=super.toJSON();return e.v1=this.v1.toArray(),e.v2=this.v2.toArray(),e}fromJSON(e){return super.fromJSON(e),this.v1.fromArray(e.v1),this.v2.fromArray(e.v2),this}},Wv=class extends xv{constructor(e=new Q,t=new Q){super(),this.isLineCurve3=!0,this.type=`LineCurve3`,this.v1=e,this.v2=t}getPoint(e,t=new Q){let n=t;return e===1?n.copy(this.v2):(n.copy(this.v2).sub(this.v1),n.multiplyScalar(e).add(this.v1)),n}getPointAt(e,t){return this.getPoint(e,t)}getTangent(e,t=new Q){return t.subVectors(this.v2,this.v1).normalize()}getTangentAt(e,t){return this.getTangent(e,t)}copy(e){return super.copy(e),this.v1.copy(e.v1),this.v2.copy(e.v2),this}toJSON(){let e=super.toJSON();return e.v1=this.v1.toArray(),e.v2=this.v2.toArray(),e}fromJSON(e){return super.fromJSON(e),this.v1.fromArray(e.v1),this.v2.fromArray(e.v2),this}},Gv=class extends xv{constructor(e=new Z,t=new Z,n=new Z){super(),this.isQuadraticBezierCurve=!0,this.type=`QuadraticBezierCurve`,this.v0=e,this.v1=t,this.v2=n}getPoint(e,t=new Z){let n=t,r=this.v0,i=this.v1,a=this.v2;return n.set(Fv(e,r.x,i.x,a.x),Fv(e,r.y,i.y,a.y)),n}copy(e){return super.copy(e),this.v0.copy(e.v0),this.v1.copy(e.v1),this.v2.copy(e.v2),this}toJSON(){let e=super.toJSON();return e.v0=this.v0.toArray(),e.v1=this.v1.toArray(),e.v2=this.v2.toArray(),e}fromJSON(e){return super.fromJSON(e),this.v0.fromArray(e.v0),this.v1.fromArray(e.v1),this.v2.fromArray(e.v2),this}},Kv=class extends xv{constructor(e=new Q,t=new Q,n=new Q){super(),this.isQuadraticBezierCurve3=!0,this.type=`QuadraticBezierCurve3`,this.v0=e,this.v1=t,this.v2=n}getPoint(e,t=new Q){let n=t,r=this.v0,i=this.v1,a=this.v2;return n.set(Fv(e,r.x,i.x,a.x),Fv(e,r.y,i.y,a.y),Fv(e,r.z,i.z,a.z)),n}copy(e){return super.copy(e),this.v0.copy(e.v0),this.v1.copy(e.v1),this.v2.copy(e.v2),this}toJSON(){let e=super.toJSON();return e.v0=this.v0.toArray(),e.v1=this.v1.toArray(),e.v2=this.v2.toArray(),e}fromJSON(e){return super.fromJSON(e),this.v0.fromArray(e.v0),this.v1.fromArray(e.v1),this.v2.fromArray(e.v2),this}},qv=class extends xv{constructor(e=[]){super(),this.isSplineCurve=!0,this.type=`SplineCurve`,this.points=e}getPoint(e,t=new Z){let n=t,r=this.points,i=(r.length-1)*e,a=Math.floor(i),o=i-a,s=r[a===0?a:a-1],c=r[a],l=r[a>r.length-2?r.length-1:a+1],u=r[a>r.length-3?r.length-1:a+2];return n.set(jv(o,s.x,c.x,l.x,u.x),jv(o,s.y,c.y,l.y,u.y)),n}copy(e){super.copy(e),this.points=[];for(let t=0,n=e.points.length;t<n;t++){let n=e.points[t];this.points.push(n.clone())}return this}toJSON(){let e=super.toJSON();e.points=[];for(let t=0,n=this.points.length;t<n;t++){let n=this.points[t];e.points.push(n.toArray())}return e}fromJSON(e){super.fromJSON(e),this.points=[];for(let t=0,n=e.points.length;t<n;t++){let n=e.points[t];this.points.push(new Z().fromArray(n))}return this}},Jv=Object.freeze({__proto__:null,ArcCurve:Cv,CatmullRomCurve3:Av,CubicBezierCurve:Vv,CubicBezierCurve3:Hv,EllipseCurve:Sv,LineCurve:Uv,LineCurve3:Wv,QuadraticBezierCurve:Gv,QuadraticBezierCurve3:Kv,SplineCurve:qv}),Yv=class extends xv{constructor(){super(),this.type=`CurvePath`,this.curves=[],this.autoClose=!1,this.cacheLengths=null}add(e){this.curves.push(e)}closePath(){let e=this.curves[0].getPoint(0),t=this.curves[this.curves.length-1].getPoint(1);if(!e.equals(t)){let n=e.isVector2===!0?`LineCurve`:`LineCurve3`;this.curves.push(new Jv[n](t,e))}return this}getPoint(e,t){let n=e*this.getLength(),r=this.getCurveLengths(),i=0;for(;i<r.length;){if(r[i]>=n){let e=r[i]-n,a=this.curves[i],o=a.getLength(),s=o===0?0:1-e/o;return a.getPointAt(s,t)}i++}return null}getLength(){let e=this.getCurveLengths();return e[e.length-1]}updateArcLengths(){this.needsUpdate=!0,this.cacheLengths=null,this.getCurveLengths()}getCurveLengths(){if(this.cacheLengths&&this.cacheLengths.length===this.curves.length)return this.cacheLengths;let e=[],t=0;for(let n=0,r=this.curves.length;n<r;n++)t+=this.curves[n].getLength(),e.push(t);return this.cacheLengths=e,e}getSpacedPoints(e=40){let t=[];for(let n=0;n<=e;n++)t.push(this.getPoint(n/e));return this.autoClose&&t.push(t[0]),t}getPoints(e=12){let t=[],n;for(let r=0,i=this.curves;r<i.length;r++){let a=i[r],o=a.isEllipseCurve?e*2:a.isLineCurve||a.isLineCurve3?1:a.isSplineCurve?e*a.points.length:e,s=a.getPoints(o);for(let e=0;e<s.length;e++){let r=s[e];n&&n.equals(r)||(t.push(r),n=r)}}return this.autoClose&&t.length>1&&!t[t.length-1].equals(t[0])&&t.push(t[0]),t}copy(e){super.copy(e),this.curves=[];for(let t=0,n=e.curves.length;t<n;t++){let n=e.curves[t];this.curves.push(n.clone())}return this.autoClose=e.autoClose,this.cacheLengths=null,this}toJSON(){let e=super.toJSON();e.autoClose=this.autoClose,e.curves=[];for(let t=0,n=this.curves.length;t<n;t++){let n=this.curves[t];e.curves.push(n.toJSON())}return e}fromJSON(e){super.fromJSON(e),this.autoClose=e.autoClose,this.curves=[];for(let t=0,n=e.curves.length;t<n;t++){let n=e.curves[t];this.curves.push(new Jv[n.type]().fromJSON(n))}return this.cacheLengths=null,this}},Xv=class extends Yv{constructor(e){super(),this.type=`Path`,this.currentPoint=new Z,e&&this.setFromPoints(e)}setFromPoints(e){this.moveTo(e[0].x,e[0].y);for(let t=1,n=e.length;t<n;t++)this.lineTo(e[t].x,e[t].y);return this}moveTo(e,t){return this.currentPoint.set(e,t),this}lineTo(e,t){let n=new Uv(this.currentPoint.clone(),new Z(e,t));return this.curves.push(n),this.currentPoint.set(e,t),this}quadraticCurveTo(e,t,n,r){let i=new Gv(this.currentPoint.clone(),new Z(e,t),new Z(n,r));return this.curves.push(i),this.currentPoint.set(n,r),this}bezierCurveTo(e,t,n,r,i,a){let o=new Vv(this.currentPoint.clone(),new Z(e,t),new Z(n,r),new Z(i,a));return this.curves.push(o),this.currentPoint.set(i,a),this}splineThru(e){let t=new qv([this.currentPoint.clone()].concat(e));return this.curves.push(t),this.currentPoint.copy(e[e.length-1]),this}arc(e,t,n,r,i,a){let o=this.currentPoint.x,s=this.currentPoint.y;return this.absarc(e+o,t+s,n,r,i,a),this}absarc(e,t,n,r,i,a){return this.absellipse(e,t,n,n,r,i,a),this}ellipse(e,t,n,r,i,a,o,s){let c=this.currentPoint.x,l=this.currentPoint.y;return this.absellipse(e+c,t+l,n,r,i,a,o,s),this}absellipse(e,t,n,r,i,a,o,s){let c=new Sv(e,t,n,r,i,a,o,s);if(this.curves.length>0){let e=c.getPoint(0);e.equals(this.currentPoint)||this.lineTo(e.x,e.y)}this.curves.push(c);let l=c.getPoint(1);return this.currentPoint.copy(l),this}copy(e){return super.copy(e),this.currentPoint.copy(e.currentPoint),this}toJSON(){let e=super.toJSON();return e.currentPoint=this.currentPoint.toArray(),e}fromJSON(e){return super.fromJSON(e),this.currentPoint.fromArray(e.currentPoint),this}},Zv=class extends Xv{constructor(e){super(e),this.uuid=Mm(),this.type=`Shape`,this.holes=[]}getPointsHoles(e){let t=[];for(let n=0,r=this.holes.length;n<r;n++)t[n]=this.holes[n].getPoints(e);return t}extractPoints(e){return{shape:this.getPoints(e),holes:this.getPointsHoles(e)}}copy(e){super.copy(e),this.holes=[];for(let t=0,n=e.holes.length;t<n;t++){let n=e.holes[t];this.holes.push(n.clone())}return this}toJSON(){let e=super.toJSON();e.uuid=this.uuid,e.holes=[];for(let t=0,n=this.holes.length;t<n;t++){let n=this.holes[t];e.holes.push(n.toJSON())}return e}fromJSON(e){super.fromJSON(e),this.uuid=e.uuid,this.holes=[];for(let t=0,n=e.holes.length;t<n;t++){let n=e.holes[t];this.holes.push(new Xv().fromJSON(n))}return this}};function Qv(e,t,n=2){let r=t&&t.length,i=r?t[0]*n:e.length,a=$v(e,0,i,n,!0),o=[];if(!a||a.next===a.prev)return o;let s,c,l;if(r&&(a=oy(e,t,a,n)),e.length>80*n){s=e[0],c=e[1];let t=s,r=c;for(let a=n;a<i;a+=n){let n=e[a],i=e[a+1];n<s&&(s=n),i<c&&(c=i),n>t&&(t=n),i>r&&(r=i)}l=Math.max(t-s,r-c),l=l===0?0:32767/l}return ty(a,o,n,s,c,l,0),o}function $v(e,t,n,r,i){let a;if(i===Ay(e,t,n,r)>0)for(let i=t;i<n;i+=r)a=Dy(i/r|0,e[i],e[i+1],a);else for(let i=n-r;i>=t;i-=r)a=Dy(i/r|0,e[i],e[i+1],a);return a&&yy(a,a.next)&&(Oy(a),a=a.next),a}function ey(e,t){if(!e)return e;t||=e;let n=e,r;do if(r=!1,!n.steiner&&(yy(n,n.next)||vy(n.prev,n,n.next)===0)){if(Oy(n),n=t=n.prev,n===n.next)break;r=!0}else n=n.next;while(r||n!==t);return t}function ty(e,t,n,r,i,a,o){if(!e)return;!o&&a&&dy(e,r,i,a);let s=e;for(;e.prev!==e.next;){let c=e.prev,l=e.next;if(a?ry(e,r,i,a):ny(e))t.push(c.i,e.i,l.i),Oy(e),e=l.next,s=l.next;else if(e=l,e===s){o?o===1?(e=iy(ey(e),t),ty(e,t,n,r,i,a,2)):o===2&&ay(e,t,n,r,i,a):ty(ey(e),t,n,r,i,a,1);break}}}function ny(e){let t=e.prev,n=e,r=e.next;if(vy(t,n,r)>=0)return!1;let i=t.x,a=n.x,o=r.x,s=t.y,c=n.y,l=r.y,u=Math.min(i,a,o),d=Math.min(s,c,l),f=Math.max(i,a,o),p=Math.max(s,c,l),m=r.next;for(;m!==t;){if(m.x>=u&&m.x<=f&&m.y>=d&&m.y<=p&&gy(i,s,a,c,o,l,m.x,m.y)&&vy(m.prev,m,m.next)>=0)return!1;m=m.next}return!0}function ry(e,t,n,r){let i=e.prev,a=e,o=e.next;if(vy(i,a,o)>=0)return!1;let s=i.x,c=a.x,l=o.x,u=i.y,d=a.y,f=o.y,p=Math.min(s,c,l),m=Math.min(u,d,f),h=Math.max(s,c,l),g=Math.max(u,d,f),_=py(p,m,t,n,r),v=py(h,g,t,n,r),y=e.prevZ,b=e.nextZ;for(;y&&y.z>=_&&b&&b.z<=v;){if(y.x>=p&&y.x<=h&&y.y>=m&&y.y<=g&&y!==i&&y!==o&&gy(s,u,c,d,l,f,y.x,y.y)&&vy(y.prev,y,y.next)>=0||(y=y.prevZ,b.x>=p&&b.x<=h&&b.y>=m&&b.y<=g&&b!==i&&b!==o&&gy(s,u,c,d,l,f,b.x,b.y)&&vy(b.prev,b,b.next)>=0))return!1;b=b.nextZ}for(;y&&y.z>=_;){if(y.x>=p&&y.x<=h&&y.y>=m&&y.y<=g&&y!==i&&y!==o&&gy(s,u,c,d,l,f,y.x,y.y)&&vy(y.prev,y,y.next)>=0)return!1;y=y.prevZ}for(;b&&b.z<=v;){if(b.x>=p&&b.x<=h&&b.y>=m&&b.y<=g&&b!==i&&b!==o&&gy(s,u,c,d,l,f,b.x,b.y)&&vy(b.prev,b,b.next)>=0)return!1;b=b.nextZ}return!0}function iy(e,t){let n=e;do{let r=n.prev,i=n.next.next;!yy(r,i)&&by(r,n,n.next,i)&&wy(r,i)&&wy(i,r)&&(t.push(r.i,n.i,i.i),Oy(n),Oy(n.next),n=e=i),n=n.next}while(n!==e);return ey(n)}function ay(e,t,n,r,i,a){let o=e;do{let e=o.next.next;for(;e!==o.prev;){if(o.i!==e.i&&_y(o,e)){let s=Ey(o,e);o=ey(o,o.next),s=ey(s,s.next),ty(o,t,n,r,i,a,0),ty(s,t,n,r,i,a,0);return}e=e.next}o=o.next}while(o!==e)}function oy(e,t,n,r){let i=[];for(let n=0,a=t.length;n<a;n++){let o=$v(e,t[n]*r,n<a-1?t[n+1]*r:e.length,r,!1);o===o.next&&(o.steiner=!0),i.push(my(o))}i.sort(sy);for(let e=0;e<i.length;e++)n=cy(i[e],n);return n}function sy(e,t){let n=e.x-t.x;return n===0&&(n=e.y-t.y,n===0&&(n=(e.next.y-e.y)/(e.next.x-e.x)-(t.next.y-t.y)/(t.next.x-t.x))),n}function cy(e,t){let n=ly(e,t);if(!n)return t;let r=Ey(n,e);return ey(r,r.next),ey(n,n.next)}function ly(e,t){let n=t,r=e.x,i=e.y,a=-1/0,o;if(yy(e,n))return n;do{if(yy(e,n.next))return n.next;if(i<=n.y&&i>=n.next.y&&n.next.y!==n.y){let e=n.x+(i-n.y)*(n.next.x-n.x)/(n.next.y-n.y);if(e<=r&&e>a&&(a=e,o=n.x<n.next.x?n:n.next,e===r))return o}n=n.next}while(n!==t);if(!o)return null;let s=o,c=o.x,l=o.y,u=1/0;n=o;do{if(r>=n.x&&n.x>=c&&r!==n.x&&hy(i<l?r:a,i,c,l,i<l?a:r,i,n.x,n.y)){let t=Math.abs(i-n.y)/(r-n.x);wy(n,e)&&(t<u||t===u&&(n.x>o.x||n.x===o.x&&uy(o,n)))&&(o=n,u=t)}n=n.next}while(n!==s);return o}function uy(e,t){return vy(e.prev,e,t.prev)<0&&vy(t.next,e,e.next)<0}function dy(e,t,n,r){let i=e;do i.z===0&&(i.z=py(i.x,i.y,t,n,r)),i.prevZ=i.prev,i.nextZ=i.next,i=i.next;while(i!==e);i.prevZ.nextZ=null,i.prevZ=null,fy(i)}function fy(e){let t,n=1;do{let r=e,i;e=null;let a=null;for(t=0;r;){t++;let o=r,s=0;for(let e=0;e<n&&(s++,o=o.nextZ,o);e++);let c=n;for(;s>0||c>0&&o;)s!==0&&(c===0||!o||r.z<=o.z)?(i=r,r=r.nextZ,s--):(i=o,o=o.nextZ,c--),a?a.nextZ=i:e=i,i.prevZ=a,a=i;r=o}a.nextZ=null,n*=2}while(t>1);return e}function py(e,t,n,r,i){return e=(e-n)*i|0,t=(t-r)*i|0,e=(e|e<<8)&16711935,e=(e|e<<4)&252645135,e=(e|e<<2)&858993459,e=(e|e<<1)&1431655765,t=(t|t<<8)&16711935,t=(t|t<<4)&252645135,t=(t|t<<2)&858993459,t=(t|t<<1)&1431655765,e|t<<1}function my(e){let t=e,n=e;do(t.x<n.x||t.x===n.x&&t.y<n.y)&&(n=t),t=t.next;while(t!==e);return n}function hy(e,t,n,r,i,a,o,s){return(i-o)*(t-s)>=(e-o)*(a-s)&&(e-o)*(r-s)>=(n-o)*(t-s)&&(n-o)*(a-s)>=(i-o)*(r-s)}function gy(e,t,n,r,i,a,o,s){return(e!==o||t!==s)&&hy(e,t,n,r,i,a,o,s)}function _y(e,t){return e.next.i!==t.i&&e.prev.i!==t.i&&!Cy(e,t)&&(wy(e,t)&&wy(t,e)&&Ty(e,t)&&(vy(e.prev,e,t.prev)||vy(e,t.prev,t))||yy(e,t)&&vy(e.prev,e,e.next)>0&&vy(t.prev,t,t.next)>0)}function vy(e,t,n){return(t.y-e.y)*(n.x-t.x)-(t.x-e.x)*(n.y-t.y)}function yy(e,t){return e.x===t.x&&e.y===t.y}function by(e,t,n,r){let i=Sy(vy(e,t,n)),a=Sy(vy(e,t,r)),o=Sy(vy(n,r,e)),s=Sy(vy(n,r,t));return!!(i!==a&&o!==s||i===0&&xy(e,n,t)||a===0&&xy(e,r,t)||o===0&&xy(n,e,r)||s===0&&xy(n,t,r))}function xy(e,t,n){return t.x<=Math.max(e.x,n.x)&&t.x>=Math.min(e.x,n.x)&&t.y<=Math.max(e.y,n.y)&&t.y>=Math.min(e.y,n.y)}function Sy(e){return e>0?1:e<0?-1:0}function Cy(e,t){let n=e;do{if(n.i!==e.i&&n.next.i!==e.i&&n.i!==t.i&&n.next.i!==t.i&&by(n,n.next,e,t))return!0;n=n.next}while(n!==e);return!1}function wy(e,t){return vy(e.prev,e,e.next)<0?vy(e,t,e.next)>=0&&vy(e,e.prev,t)>=0:vy(e,t,e.prev)<0||vy(e,e.next,t)<0}function Ty(e,t){let n=e,r=!1,i=(e.x+t.x)/2,a=(e.y+t.y)/2;do n.y>a!=n.next.y>a&&n.next.y!==n.y&&i<(n.next.x-n.x)*(a-n.y)/(n.next.y-n.y)+n.x&&(r=!r),n=n.next;while(n!==e);return r}function Ey(e,t){let n=ky(e.i,e.x,e.y),r=ky(t.i,t.x,t.y),i=e.next,a=t.prev;return e.next=t,t.prev=e,n.next=i,i.prev=n,r.next=n,n.prev=r,a.next=r,r.prev=a,r}function Dy(e,t,n,r){let i=ky(e,t,n);return r?(i.next=r.next,i.prev=r,r.next.prev=i,r.next=i):(i.prev=i,i.next=i),i}function Oy(e){e.next.prev=e.prev,e.prev.next=e.next,e.prevZ&&(e.prevZ.nextZ=e.nextZ),e.nextZ&&(e.nextZ.prevZ=e.prevZ)}function ky(e,t,n){return{i:e,x:t,y:n,prev:null,next:null,z:0,prevZ:null,nextZ:null,steiner:!1}}function Ay(e,t,n,r){let i=0;for(let a=t,o=n-r;a<n;a+=r)i+=(e[o]-e[a])*(e[a+1]+e[o+1]),o=a;return i}var jy=class{static triangulate(e,t,n=2){return Qv(e,t,n)}},My=class e{static area(e){let t=e.length,n=0;for(let r=t-1,i=0;i<t;r=i++)n+=e[r].x*e[i].y-e[i].x*e[r].y;return n*.5}static isClockWise(t){return e.area(t)<0}static triangulateShape(e,t){let n=[],r=[],i=[];Ny(e),Py(n,e);let a=e.length;t.forEach(Ny);for(let e=0;e<t.length;e++)r.push(a),a+=t[e].length,Py(n,t[e]);let o=jy.triangulate(n,r);for(let e=0;e<o.length;e+=3)i.push(o.slice(e,e+3));return i}};function Ny(e){let t=e.length;t>2&&e[t-1].equals(e[0])&&e.pop()}function Py(e,t){for(let n=0;n<t.length;n++)e.push(t[n].x),e.push(t[n].y)}var Fy=class e extends r_{constructor(e=1,t=1,n=1,r=1){super(),this.type=`PlaneGeometry`,this.parameters={width:e,height:t,widthSegments:n,heightSegments:r};let i=e/2,a=t/2,o=Math.floor(n),s=Math.floor(r),c=o+1,l=s+1,u=e/o,d=t/s,f=[],p=[],m=[],h=[];for(let e=0;e<l;e++){let t=e*d-a;for(let n=0;n<c;n++){let r=n*u-i;p.push(r,-t,0),m.push(0,0,1),h.push(n/o),h.push(1-e/s)}}for(let e=0;e<s;e++)for(let t=0;t<o;t++){let n=t+c*e,r=t+c*(e+1),i=t+1+c*(e+1),a=t+1+c*e;f.push(n,r,a),f.push(r,i,a)}this.setIndex(f),this.setAttribute(`position`,new Gg(p,3)),this.setAttribute(`normal`,new Gg(m,3)),this.setAttribute(`uv`,new Gg(h,2))}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}static fromJSON(t){return new e(t.width,t.height,t.widthSegments,t.heightSegments)}},Iy=class e extends r_{constructor(e=new Zv([new Z(0,.5),new Z(-.5,-.5),new Z(.5,-.5)]),t=12){super(),this.type=`ShapeGeometry`,this.parameters={shapes:e,curveSegments:t};let n=[],r=[],i=[],a=[],o=0,s=0;if(Array.isArray(e)===!1)c(e);else for(let t=0;t<e.length;t++)c(e[t]),this.addGroup(o,s,t),o+=s,s=0;this.setIndex(n),this.setAttribute(`position`,new Gg(r,3)),this.setAttribute(`normal`,new Gg(i,3)),this.setAttribute(`uv`,new Gg(a,2));function c(e){let o=r.length/3,c=e.extractPoints(t),l=c.shape,u=c.holes;My.isClockWise(l)===!1&&(l=l.reverse());for(let e=0,t=u.length;e<t;e++){let t=u[e];My.isClockWise(t)===!0&&(u[e]=t.reverse())}let d=My.triangulateShape(l,u);for(let e=0,t=u.length;e<t;e++){let t=u[e];l=l.concat(t)}for(let e=0,t=l.length;e<t;e++){let t=l[e];r.push(t.x,t.y,0),i.push(0,0,1),a.push(t.x,t.y)}for(let e=0,t=d.length;e<t;e++){let t=d[e],r=t[0]+o,i=t[1]+o,a=t[2]+o;n.push(r,i,a),s+=3}}}copy(e){return super.copy(e),this.parameters=Object.assign({},e.parameters),this}toJSON(){let e=super.toJSON(),t=this.parameters.shapes;return Ly(t,e)}static fromJSON(t,n){let r=[];for(let e=0,i=t.shapes.length;e<i;e++){let i=n[t.shapes[e]];r.push(i)}return new e(r,t.curveSegments)}};function Ly(e,t){if(t.shapes=[],Array.isArray(e))for(let n=0,r=e.length;n<r;n++){let r=e[n];t.shapes.push(r.uuid)}else t.shapes.push(e.uuid);return t}function Ry(e){let t={};for(let n in e){t[n]={};for(let r in e[n]){let i=e[n][r];if(By(i))i.isRenderTargetTexture?(Sm(`UniformsUtils: Textures of render targets cannot be cloned via cloneUniforms() or mergeUniforms().`),t[n][r]=null):t[n][r]=i.clone();else if(Array.isArray(i)){if(By(i[0])){let e=[];for(let t=0,n=i.length;t<n;t++)e[t]=i[t].clone();t[n][r]=e}else t[n][r]=i.slice()}else t[n][r]=i}}return t}function zy(e){let t={};for(let n=0;n<e.length;n++){let r=Ry(e[n]);for(let e in r)t[e]=r[e]}return t}function By(e){return e&&(e.isColor||e.isMatrix3||e.isMatrix4||e.isVector2||e.isVector3||e.isVector4||e.isTexture||e.isQuaternion)}function Vy(e){let t=[];for(let n=0;n<e.length;n++)t.push(e[n].clone());return t}function Hy(e){let t=e.getRenderTarget();return t===null?e.outputColorSpace:t.isXRRenderTarget===!0?t.texture.colorSpace:uh.workingColorSpace}var Uy={clone:Ry,merge:zy},Wy=`void main() {
	gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
}`,Gy=`void main() {
	gl_FragColor = vec4( 1.0, 0.0, 0.0, 1.0 );
}`,Ky=class extends p_{constructor(e){super(),this.isShaderMaterial=!0,this.type=`ShaderMaterial`,this.defines={},this.uniforms={},this.uniformsGroups=[],this.vertexShader=Wy,this.fragmentShader=Gy,this.linewidth=1,this.wireframe=!1,this.wireframeLinewidth=1,this.fog=!1,this.lights=!1,this.clipping=!1,this.forceSinglePass=!0,this.extensions={clipCullDistance:!1,multiDraw:!1},this.defaultAttributeValues={color:[1,1,1],uv:[0,0],uv1:[0,0]},this.index0AttributeName=void 0,this.uniformsNeedUpdate=!1,this.glslVersion=null,e!==void 0&&this.setValues(e)}copy(e){return super.copy(e),this.fragmentShader=e.fragmentShader,this.vertexShader=e.vertexShader,this.uniforms=Ry(e.uniforms),this.uniformsGroups=Vy(e.uniformsGroups),this.defines=Object.assign({},e.defines),this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.fog=e.fog,this.lights=e.lights,this.clipping=e.clipping,this.extensions=Object.assign({},e.extensions),this.glslVersion=e.glslVersion,this.defaultAttributeValues=Object.assign({},e.defaultAttributeValues),this.index0AttributeName=e.index0AttributeName,this.uniformsNeedUpdate=e.uniformsNeedUpdate,this}toJSON(e){let t=super.toJSON(e);t.glslVersion=this.glslVersion,t.uniforms={};for(let n in this.uniforms){let r=this.uniforms[n].value;r&&r.isTexture?t.uniforms[n]={type:`t`,value:r.toJSON(e).uuid}:r&&r.isColor?t.uniforms[n]={type:`c`,value:r.getHex()}:r&&r.isVector2?t.uniforms[n]={type:`v2`,value:r.toArray()}:r&&r.isVector3?t.uniforms[n]={type:`v3`,value:r.toArray()}:r&&r.isVector4?t.uniforms[n]={type:`v4`,value:r.toArray()}:r&&r.isMatrix3?t.uniforms[n]={type:`m3`,value:r.toArray()}:r&&r.isMatrix4?t.uniforms[n]={type:`m4`,value:r.toArray()}:t.uniforms[n]={value:r}}Object.keys(this.defines).length>0&&(t.defines=this.defines),t.vertexShader=this.vertexShader,t.fragmentShader=this.fragmentShader,t.lights=this.lights,t.clipping=this.clipping;let n={};for(let e in this.extensions)this.extensions[e]===!0&&(n[e]=!0);return Object.keys(n).length>0&&(t.extensions=n),t}fromJSON(e,t){if(super.fromJSON(e,t),e.uniforms!==void 0)for(let n in e.uniforms){let r=e.uniforms[n];switch(this.uniforms[n]={},r.type){case`t`:this.uniforms[n].value=t[r.value]||null;break;case`c`:this.uniforms[n].value=new sg().setHex(r.value);break;case`v2`:this.uniforms[n].value=new Z().fromArray(r.value);break;case`v3`:this.uniforms[n].value=new Q().fromArray(r.value);break;case`v4`:this.uniforms[n].value=new xh().fromArray(r.value);break;case`m3`:this.uniforms[n].value=new ah().fromArray(r.value);break;case`m4`:this.uniforms[n].value=new Eh().fromArray(r.value);break;default:this.uniforms[n].value=r.value}}if(e.defines!==void 0&&(this.defines=e.defines),e.vertexShader!==void 0&&(this.vertexShader=e.vertexShader),e.fragmentShader!==void 0&&(this.fragmentShader=e.fragmentShader),e.glslVersion!==void 0&&(this.glslVersion=e.glslVersion),e.extensions!==void 0)for(let t in e.extensions)this.extensions[t]=e.extensions[t];return e.lights!==void 0&&(this.lights=e.lights),e.clipping!==void 0&&(this.clipping=e.clipping),this}},qy=class extends Ky{constructor(e){super(e),this.isRawShaderMaterial=!0,this.type=`RawShaderMaterial`}},Jy=class extends p_{constructor(e){super(),this.isMeshStandardMaterial=!0,this.type=`MeshStandardMaterial`,this.defines={STANDARD:``},this.color=new sg(16777215),this.roughness=1,this.metalness=0,this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.emissive=new sg(0),this.emissiveIntensity=1,this.emissiveMap=null,this.bumpMap=null,this.bumpScale=1,this.normalMap=null,this.normalMapType=0,this.normalScale=new Z(1,1),this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.roughnessMap=null,this.metalnessMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new Ih,this.envMapIntensity=1,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap=`round`,this.wireframeLinejoin=`round`,this.flatShading=!1,this.fog=!0,this.setValues(e)}copy(e){return super.copy(e),this.defines={STANDARD:``},this.color.copy(e.color),this.roughness=e.roughness,this.metalness=e.metalness,this.map=e.map,this.lightMap=e.lightMap,this.lightMapIntensity=e.lightMapIntensity,this.aoMap=e.aoMap,this.aoMapIntensity=e.aoMapIntensity,this.emissive.copy(e.emissive),this.emissiveMap=e.emissiveMap,this.emissiveIntensity=e.emissiveIntensity,this.bumpMap=e.bumpMap,this.bumpScale=e.bumpScale,this.normalMap=e.normalMap,this.normalMapType=e.normalMapType,this.normalScale.copy(e.normalScale),this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this.roughnessMap=e.roughnessMap,this.metalnessMap=e.metalnessMap,this.alphaMap=e.alphaMap,this.envMap=e.envMap,this.envMapRotation.copy(e.envMapRotation),this.envMapIntensity=e.envMapIntensity,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this.wireframeLinecap=e.wireframeLinecap,this.wireframeLinejoin=e.wireframeLinejoin,this.flatShading=e.flatShading,this.fog=e.fog,this}},Yy=class extends p_{constructor(e){super(),this.isMeshDepthMaterial=!0,this.type=`MeshDepthMaterial`,this.depthPacking=sm,this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.wireframe=!1,this.wireframeLinewidth=1,this.setValues(e)}copy(e){return super.copy(e),this.depthPacking=e.depthPacking,this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this.wireframe=e.wireframe,this.wireframeLinewidth=e.wireframeLinewidth,this}},Xy=class extends p_{constructor(e){super(),this.isMeshDistanceMaterial=!0,this.type=`MeshDistanceMaterial`,this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.setValues(e)}copy(e){return super.copy(e),this.map=e.map,this.alphaMap=e.alphaMap,this.displacementMap=e.displacementMap,this.displacementScale=e.displacementScale,this.displacementBias=e.displacementBias,this}},Zy=class extends rv{constructor(e){super(),this.isLineDashedMaterial=!0,this.type=`LineDashedMaterial`,this.scale=1,this.dashSize=3,this.gapSize=1,this.setValues(e)}copy(e){return super.copy(e),this.scale=e.scale,this.dashSize=e.dashSize,this.gapSize=e.gapSize,this}};function Qy(e,t){return!e||e.constructor===t?e:typeof t.BYTES_PER_ELEMENT==`number`?new t(e):Array.prototype.slice.call(e)}function $y(e){return e!==void 0&&e.inTangents!==void 0&&e.outTangents!==void 0}var eb=class{constructor(e,t,n,r){this.parameterPositions=e,this._cachedIndex=0,this.resultBuffer=r===void 0?new t.constructor(n):r,this.sampleValues=t,this.valueSize=n,this.settings=null,this.DefaultSettings_={}}evaluate(e){let t=this.parameterPositions,n=this._cachedIndex,r=t[n],i=t[n-1];validate_interval:{seek:{let a;linear_scan:{forward_scan:if(!(e<r)){for(let a=n+2;;){if(r===void 0){if(e<i)break forward_scan;return n=t.length,this._cachedIndex=n,this.copySampleValue_(n-1)}if(n===a)break;if(i=r,r=t[++n],e<r)break seek}a=t.length;break linear_scan}if(!(e>=i)){let o=t[1];e<o&&(n=2,i=o);for(let a=n-2;;){if(i===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(n===a)break;if(r=i,i=t[--n-1],e>=i)break seek}a=n,n=0;break linear_scan}break validate_interval}for(;n<a;){let r=n+a>>>1;e<t[r]?a=r:n=r+1}if(r=t[n],i=t[n-1],i===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(r===void 0)return n=t.length,this._cachedIndex=n,this.copySampleValue_(n-1)}this._cachedIndex=n,this.intervalChanged_(n,i,r)}return this.interpolate_(n,i,e,r)}getSettings_(){return this.settings||this.DefaultSettings_}copySampleValue_(e){let t=this.resultBuffer,n=this.sampleValues,r=this.valueSize,i=e*r;for(let e=0;e!==r;++e)t[e]=n[i+e];return t}interpolate_(){throw Error(`THREE.Interpolant: Call to abstract method.`)}intervalChanged_(){}},tb=class extends eb{constructor(e,t,n,r){super(e,t,n,r),this._weightPrev=-0,this._offsetPrev=-0,this._weightNext=-0,this._offsetNext=-0,this.DefaultSettings_={endingStart:im,endingEnd:im}}intervalChanged_(e,t,n){let r=this.parameterPositions,i=e-2,a=e+1,o=r[i],s=r[a];if(o===void 0)switch(this.getSettings_().endingStart){case am:i=e,o=2*t-n;break;case om:i=r.length-2,o=t+r[i]-r[i+1];break;default:i=e,o=n}if(s===void 0)switch(this.getSettings_().endingEnd){case am:a=e,s=2*n-t;break;case om:a=1,s=n+r[1]-r[0];break;default:a=e-1,s=t}let c=(n-t)*.5,l=this.valueSize;this._weightPrev=c/(t-o),this._weightNext=c/(s-n),this._offsetPrev=i*l,this._offsetNext=a*l}interpolate_(e,t,n,r){let i=this.resultBuffer,a=this.sampleValues,o=this.valueSize,s=e*o,c=s-o,l=this._offsetPrev,u=this._offsetNext,d=this._weightPrev,f=this._weightNext,p=(n-t)/(r-t),m=p*p,h=m*p,g=-d*h+2*d*m-d*p,_=(1+d)*h+(-1.5-2*d)*m+(-.5+d)*p+1,v=(-1-f)*h+(1.5+f)*m+.5*p,y=f*h-f*m;for(let e=0;e!==o;++e)i[e]=g*a[l+e]+_*a[c+e]+v*a[s+e]+y*a[u+e];return i}},nb=class extends eb{constructor(e,t,n,r){super(e,t,n,r)}interpolate_(e,t,n,r){let i=this.resultBuffer,a=this.sampleValues,o=this.valueSize,s=e*o,c=s-o,l=(n-t)/(r-t),u=1-l;for(let e=0;e!==o;++e)i[e]=a[c+e]*u+a[s+e]*l;return i}},rb=class extends eb{constructor(e,t,n,r){super(e,t,n,r)}interpolate_(e){return this.copySampleValue_(e-1)}},ib=class extends eb{interpolate_(e,t,n,r){let i=this.resultBuffer,a=this.sampleValues,o=this.valueSize,s=e*o,c=s-o,l=this.inTangents,u=this.outTangents;if(!l||!u){let e=(n-t)/(r-t),l=1-e;for(let t=0;t!==o;++t)i[t]=a[c+t]*l+a[s+t]*e;return i}let d=o*2,f=e-1;for(let p=0;p!==o;++p){let o=a[c+p],m=a[s+p],h=f*d+p*2,g=u[h],_=u[h+1],v=e*d+p*2,y=l[v],b=l[v+1],x=sb(n,t,g,y,r);i[p]=ab(x,o,_,b,m)}return i}};function ab(e,t,n,r,i){let a=1-e;return a*a*a*t+3*a*a*e*n+3*a*e*e*r+e*e*e*i}function ob(e,t,n,r,i){let a=1-e;return 3*a*a*(n-t)+6*a*e*(r-n)+3*e*e*(i-r)}function sb(e,t,n,r,i){let a=(e-t)/(i-t);for(let o=0;o<8;o++){let o=ab(a,t,n,r,i)-e;if(Math.abs(o)<1e-10)break;let s=ob(a,t,n,r,i);if(Math.abs(s)<1e-10)break;a=Math.max(0,Math.min(1,a-o/s))}return a}var cb=class{constructor(e,t,n,r){if(e===void 0)throw Error(`THREE.KeyframeTrack: track name is undefined`);if(t===void 0||t.length===0)throw Error(`THREE.KeyframeTrack: no keyframes in track named `+e);this.name=e,this.times=Qy(t,this.TimeBufferType),this.values=Qy(n,this.ValueBufferType),this.setInterpolation(r||this.DefaultInterpolation)}static toJSON(e){let t=e.constructor,n;if(t.toJSON!==this.toJSON)n=t.toJSON(e);else{n={name:e.name,times:Qy(e.times,Array),values:Qy(e.values,Array)};let t=e.getInterpolation();t!==e.DefaultInterpolation&&(n.interpolation=t),$y(e.settings)&&(n.settings={inTangents:Qy(e.settings.inTangents,Array),outTangents:Qy(e.settings.outTangents,Array)})}return n.type=e.ValueTypeName,n}InterpolantFactoryMethodDiscrete(e){return new rb(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodLinear(e){return new nb(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodSmooth(e){return new tb(this.times,this.values,this.getValueSize(),e)}InterpolantFactoryMethodBezier(e){let t=new ib(this.times,this.values,this.getValueSize(),e);return this.settings&&(t.inTangents=this.settings.inTangents,t.outTangents=this.settings.outTangents),t}setInterpolation(e){let t;switch(e){case em:t=this.InterpolantFactoryMethodDiscrete;break;case tm:t=this.InterpolantFactoryMethodLinear;break;case nm:t=this.InterpolantFactoryMethodSmooth;break;case rm:t=this.InterpolantFactoryMethodBezier}if(t===void 0){let t=`unsupported interpolation for `+this.ValueTypeName+` keyframe track named `+this.name;if(this.createInterpolant===void 0){if(e!==this.DefaultInterpolation)this.setInterpolation(this.DefaultInterpolation);else throw Error(t)}return Sm(`KeyframeTrack:`,t),this}return this.createInterpolant=t,this}getInterpolation(){switch(this.createInterpolant){case this.InterpolantFactoryMethodDiscrete:return em;case this.InterpolantFactoryMethodLinear:return tm;case this.InterpolantFactoryMethodSmooth:return nm;case this.InterpolantFactoryMethodBezier:return rm}}getValueSize(){return this.values.length/this.times.length}shift(e){if(e!==0){let t=this.times;for(let n=0,r=t.length;n!==r;++n)t[n]+=e;$y(this.settings)&&(lb(this.settings.inTangents,e),lb(this.settings.outTangents,e))}return this}scale(e){if(e!==1){let t=this.times;for(let n=0,r=t.length;n!==r;++n)t[n]*=e;$y(this.settings)&&(ub(this.settings.inTangents,e),ub(this.settings.outTangents,e))}return this}trim(e,t){let n=this.times,r=n.length,i=0,a=r-1;for(;i!==r&&n[i]<e;)++i;for(;a!==-1&&n[a]>t;)--a;if(++a,i!==0||a!==r){i>=a&&(a=Math.max(a,1),i=a-1);let e=this.getValueSize();this.times=n.slice(i,a),this.values=this.values.slice(i*e,a*e)}return this}validate(){let e=!0,t=this.getValueSize();t-Math.floor(t)!==0&&(Cm(`KeyframeTrack: Invalid value size in track.`,this),e=!1);let n=this.times,r=this.values,i=n.length;i===0&&(Cm(`KeyframeTrack: Track is empty.`,this),e=!1);let a=null;for(let t=0;t!==i;t++){let r=n[t];if(typeof r==`number`&&isNaN(r)){Cm(`KeyframeTrack: Time is not a valid number.`,this,t,r),e=!1;break}if(a!==null&&a>r){Cm(`KeyframeTrack: Out of order keys.`,this,t,r,a),e=!1;break}a=r}if(r!==void 0&&gm(r))for(let t=0,n=r.length;t!==n;++t){let n=r[t];if(isNaN(n)){Cm(`KeyframeTrack: Value is not a valid number.`,this,t,n),e=!1;break}}return e}optimize(){let e=this.times.slice(),t=this.values.slice(),n=this.getValueSize(),r=this.getInterpolation()===nm,i=e.length-1,a=1;for(let o=1;o<i;++o){let i=!1,s=e[o];if(s!==e[o+1]&&(o!==1||s!==e[0])){if(r)i=!0;else{let e=o*n,r=e-n,a=e+n;for(let o=0;o!==n;++o){let n=t[e+o];if(n!==t[r+o]||n!==t[a+o]){i=!0;break}}}}if(i){if(o!==a){e[a]=e[o];let r=o*n,i=a*n;for(let e=0;e!==n;++e)t[i+e]=t[r+e]}++a}}if(i>0){e[a]=e[i];for(let e=i*n,r=a*n,o=0;o!==n;++o)t[r+o]=t[e+o];++a}return a===e.length?(this.times=e,this.values=t):(this.times=e.slice(0,a),this.values=t.slice(0,a*n)),this}clone(){let e=this.times.slice(),t=this.values.slice(),n=this.constructor,r=new n(this.name,e,t);return r.createInterpolant=this.createInterpolant,$y(this.settings)&&(r.settings={inTangents:this.settings.inTangents.slice(),outTangents:this.settings.outTangents.slice()}),r}};function lb(e,t){for(let n=0,r=e.length;n!==r;n+=2)e[n]+=t}function ub(e,t){for(let n=0,r=e.length;n!==r;n+=2)e[n]*=t}cb.prototype.ValueTypeName=``,cb.prototype.TimeBufferType=Float32Array,cb.prototype.ValueBufferType=Float32Array,cb.prototype.DefaultInterpolation=tm;var db=class extends cb{constructor(e,t,n){super(e,t,n)}};db.prototype.ValueTypeName=`bool`,db.prototype.ValueBufferType=Array,db.prototype.DefaultInterpolation=em,db.prototype.InterpolantFactoryMethodLinear=void 0,db.prototype.InterpolantFactoryMethodSmooth=void 0;var fb=class extends cb{constructor(e,t,n,r){super(e,t,n,r)}};fb.prototype.ValueTypeName=`color`;var pb=class extends cb{constructor(e,t,n,r){super(e,t,n,r)}};pb.prototype.ValueTypeName=`number`;var mb=class extends eb{constructor(e,t,n,r){super(e,t,n,r)}interpolate_(e,t,n,r){let i=this.resultBuffer,a=this.sampleValues,o=this.valueSize,s=(n-t)/(r-t),c=e*o;for(let e=c+o;c!==e;c+=4)nh.slerpFlat(i,0,a,c-o,a,c,s);return i}},hb=class extends cb{constructor(e,t,n,r){super(e,t,n,r)}InterpolantFactoryMethodLinear(e){return new mb(this.times,this.values,this.getValueSize(),e)}};hb.prototype.ValueTypeName=`quaternion`,hb.prototype.InterpolantFactoryMethodSmooth=void 0;var gb=class extends cb{constructor(e,t,n){super(e,t,n)}};gb.prototype.ValueTypeName=`string`,gb.prototype.ValueBufferType=Array,gb.prototype.DefaultInterpolation=em,gb.prototype.InterpolantFactoryMethodLinear=void 0,gb.prototype.InterpolantFactoryMethodSmooth=void 0;var _b=class extends cb{constructor(e,t,n,r){super(e,t,n,r)}};_b.prototype.ValueTypeName=`vector`;var vb=class extends $h{static registerNode(e){this.prototype._lightNode=e}constructor(e,t=1){super(),this.isLight=!0,this.type=`Light`,this.color=new sg(e),this.intensity=t}copy(e,t){return super.copy(e,t),this.color.copy(e.color),this.intensity=e.intensity,this}toJSON(e){let t=super.toJSON(e);return t.object.color=this.color.getHex(),t.object.intensity=this.intensity,t}},yb=class extends vb{constructor(e,t,n){super(e,n),this.isHemisphereLight=!0,this.type=`HemisphereLight`,this.position.copy($h.DEFAULT_UP),this.updateMatrix(),this.groundColor=new sg(t)}copy(e,t){return super.copy(e,t),this.groundColor.copy(e.groundColor),this}toJSON(e){let t=super.toJSON(e);return t.object.groundColor=this.groundColor.getHex(),t}},bb=new Eh,xb=new Q,Sb=new Q,Cb=class{constructor(e){this.camera=e,this.intensity=1,this.bias=0,this.biasNode=null,this.normalBias=0,this.radius=1,this.blurSamples=8,this.mapSize=new Z(512,512),this.mapType=Yf,this.map=null,this.mapPass=null,this.matrix=new Eh,this.autoUpdate=!0,this.needsUpdate=!1,this._frustum=new ev,this._frameExtents=new Z(1,1),this._viewportCount=1,this._viewports=[new xh(0,0,1,1)]}getViewportCount(){return this._viewportCount}getCamera(){return this.camera}getFrustum(){return this._frustum}updateMatrices(e){let t=this.camera;xb.setFromMatrixPosition(e.matrixWorld),t.position.copy(xb),Sb.setFromMatrixPosition(e.target.matrixWorld),t.lookAt(Sb),t.updateMatrixWorld(),this._updateMatrix(t,this.matrix,this._frustum)}_updateMatrix(e,t,n,r){bb.multiplyMatrices(e.projectionMatrix,e.matrixWorldInverse),n.setFromProjectionMatrix(bb,e.coordinateSystem,e.reversedDepth);let i=this._frameExtents,a=r?r.z/i.x:1,o=r?r.w/i.y:1,s=r?r.x/i.x:0,c=r?r.y/i.y:0;e.coordinateSystem===2001||e.reversedDepth?t.set(.5*a,0,0,.5*a+s,0,.5*o,0,.5*o+c,0,0,1,0,0,0,0,1):t.set(.5*a,0,0,.5*a+s,0,.5*o,0,.5*o+c,0,0,.5,.5,0,0,0,1),t.multiply(bb)}getViewport(e){return this._viewports[e]}getFrameExtents(){return this._frameExtents}dispose(){this.map&&this.map.dispose(),this.mapPass&&this.mapPass.dispose()}copy(e){return this.camera=e.camera.clone(),this.intensity=e.intensity,this.bias=e.bias,this.radius=e.radius,this.autoUpdate=e.autoUpdate,this.needsUpdate=e.needsUpdate,this.normalBias=e.normalBias,this.blurSamples=e.blurSamples,this.mapSize.copy(e.mapSize),this.mapType=e.mapType,this.biasNode=e.biasNode,this}clone(){return new this.constructor().copy(this)}toJSON(){let e={};return e.intensity=this.intensity,e.bias=this.bias,e.normalBias=this.normalBias,e.radius=this.radius,e.blurSamples=this.blurSamples,e.mapSize=this.mapSize.toArray(),e.mapType=this.mapType,e.camera=this.camera.toJSON(!1).object,delete e.camera.matrix,e}},wb=new Q,Tb=new nh,Eb=new Q,Db=class extends $h{constructor(){super(),this.isCamera=!0,this.type=`Camera`,this.matrixWorldInverse=new Eh,this.projectionMatrix=new Eh,this.projectionMatrixInverse=new Eh,this.coordinateSystem=mm,this._reversedDepth=!1}get reversedDepth(){return this._reversedDepth}copy(e,t){return super.copy(e,t),this.matrixWorldInverse.copy(e.matrixWorldInverse),this.projectionMatrix.copy(e.projectionMatrix),this.projectionMatrixInverse.copy(e.projectionMatrixInverse),this.coordinateSystem=e.coordinateSystem,this}getWorldDirection(e){return super.getWorldDirection(e).negate()}updateMatrixWorld(e){super.updateMatrixWorld(e),this.matrixWorld.decompose(wb,Tb,Eb),Eb.x===1&&Eb.y===1&&Eb.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(wb,Tb,Eb.set(1,1,1)).invert()}updateWorldMatrix(e,t,n=!1){super.updateWorldMatrix(e,t,n),this.matrixWorld.decompose(wb,Tb,Eb),Eb.x===1&&Eb.y===1&&Eb.z===1?this.matrixWorldInverse.copy(this.matrixWorld).invert():this.matrixWorldInverse.compose(wb,Tb,Eb.set(1,1,1)).invert()}clone(){return new this.constructor().copy(this)}},Ob=new Q,kb=new Z,Ab=new Z,jb=class extends Db{constructor(e=50,t=1,n=.1,r=2e3){super(),this.isPerspectiveCamera=!0,this.type=`PerspectiveCamera`,this.fov=e,this.zoom=1,this.near=n,this.far=r,this.focus=10,this.aspect=t,this.view=null,this.filmGauge=35,this.filmOffset=0,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.fov=e.fov,this.zoom=e.zoom,this.near=e.near,this.far=e.far,this.focus=e.focus,this.aspect=e.aspect,this.view=e.view===null?null:Object.assign({},e.view),this.filmGauge=e.filmGauge,this.filmOffset=e.filmOffset,this}setFocalLength(e){let t=.5*this.getFilmHeight()/e;this.fov=jm*2*Math.atan(t),this.updateProjectionMatrix()}getFocalLength(){let e=Math.tan(Am*.5*this.fov);return .5*this.getFilmHeight()/e}getEffectiveFOV(){return jm*2*Math.atan(Math.tan(Am*.5*this.fov)/this.zoom)}getFilmWidth(){return this.filmGauge*Math.min(this.aspect,1)}getFilmHeight(){return this.filmGauge/Math.max(this.aspect,1)}getViewBounds(e,t,n){Ob.set(-1,-1,.5).applyMatrix4(this.projectionMatrixInverse),t.set(Ob.x,Ob.y).multiplyScalar(-e/Ob.z),Ob.set(1,1,.5).applyMatrix4(this.projectionMatrixInverse),n.set(Ob.x,Ob.y).multiplyScalar(-e/Ob.z)}getViewSize(e,t){return this.getViewBounds(e,kb,Ab),t.subVectors(Ab,kb)}setViewOffset(e,t,n,r,i,a){this.aspect=e/t,this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=n,this.view.offsetY=r,this.view.width=i,this.view.height=a,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let e=this.near,t=e*Math.tan(Am*.5*this.fov)/this.zoom,n=2*t,r=this.aspect*n,i=-.5*r,a=this.view;if(this.view!==null&&this.view.enabled){let e=a.fullWidth,o=a.fullHeight;i+=a.offsetX*r/e,t-=a.offsetY*n/o,r*=a.width/e,n*=a.height/o}let o=this.filmOffset;o!==0&&(i+=e*o/this.getFilmWidth()),this.projectionMatrix.makePerspective(i,i+r,t,t-n,e,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){let t=super.toJSON(e);return t.object.fov=this.fov,t.object.zoom=this.zoom,t.object.near=this.near,t.object.far=this.far,t.object.focus=this.focus,t.object.aspect=this.aspect,this.view!==null&&(t.object.view=Object.assign({},this.view)),t.object.filmGauge=this.filmGauge,t.object.filmOffset=this.filmOffset,t}},Mb=class extends Db{constructor(e=-1,t=1,n=1,r=-1,i=.1,a=2e3){super(),this.isOrthographicCamera=!0,this.type=`OrthographicCamera`,this.zoom=1,this.view=null,this.left=e,this.right=t,this.top=n,this.bottom=r,this.near=i,this.far=a,this.updateProjectionMatrix()}copy(e,t){return super.copy(e,t),this.left=e.left,this.right=e.right,this.top=e.top,this.bottom=e.bottom,this.near=e.near,this.far=e.far,this.zoom=e.zoom,this.view=e.view===null?null:Object.assign({},e.view),this}setViewOffset(e,t,n,r,i,a){this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=e,this.view.fullHeight=t,this.view.offsetX=n,this.view.offsetY=r,this.view.width=i,this.view.height=a,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let e=(this.right-this.left)/(2*this.zoom),t=(this.top-this.bottom)/(2*this.zoom),n=(this.right+this.left)/2,r=(this.top+this.bottom)/2,i=n-e,a=n+e,o=r+t,s=r-t;if(this.view!==null&&this.view.enabled){let e=(this.right-this.left)/this.view.fullWidth/this.zoom,t=(this.top-this.bottom)/this.view.fullHeight/this.zoom;i+=e*this.view.offsetX,a=i+e*this.view.width,o-=t*this.view.offsetY,s=o-t*this.view.height}this.projectionMatrix.makeOrthographic(i,a,o,s,this.near,this.far,this.coordinateSystem,this.reversedDepth),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(e){let t=super.toJSON(e);return t.object.zoom=this.zoom,t.object.left=this.left,t.object.right=this.right,t.object.top=this.top,t.object.bottom=this.bottom,t.object.near=this.near,t.object.far=this.far,this.view!==null&&(t.object.view=Object.assign({},this.view)),t}},Nb=class extends Cb{constructor(){super(new Mb(-5,5,5,-5,.5,500)),this.isDirectionalLightShadow=!0}},Pb=class extends vb{constructor(e,t){super(e,t),this.isDirectionalLight=!0,this.type=`DirectionalLight`,this.position.copy($h.DEFAULT_UP),this.updateMatrix(),this.target=new $h,this.shadow=new Nb}dispose(){super.dispose(),this.shadow.dispose()}copy(e){return super.copy(e),this.target=e.target.clone(),this.shadow=e.shadow.clone(),this}toJSON(e){let t=super.toJSON(e);return t.object.shadow=this.shadow.toJSON(),t.object.target=this.target.uuid,t}},Fb=class extends vb{constructor(e,t){super(e,t),this.isAmbientLight=!0,this.type=`AmbientLight`}},Ib=-90,Lb=1,Rb=class extends $h{constructor(e,t,n){super(),this.type=`CubeCamera`,this.renderTarget=n,this.coordinateSystem=null,this.activeMipmapLevel=0;let r=new jb(Ib,Lb,e,t);r.layers=this.layers,this.add(r);let i=new jb(Ib,Lb,e,t);i.layers=this.layers,this.add(i);let a=new jb(Ib,Lb,e,t);a.layers=this.layers,this.add(a);let o=new jb(Ib,Lb,e,t);o.layers=this.layers,this.add(o);let s=new jb(Ib,Lb,e,t);s.layers=this.layers,this.add(s);let c=new jb(Ib,Lb,e,t);c.layers=this.layers,this.add(c)}updateCoordinateSystem(){let e=this.coordinateSystem,t=this.children.concat(),[n,r,i,a,o,s]=t;for(let e of t)this.remove(e);if(e===2e3)n.up.set(0,1,0),n.lookAt(1,0,0),r.up.set(0,1,0),r.lookAt(-1,0,0),i.up.set(0,0,-1),i.lookAt(0,1,0),a.up.set(0,0,1),a.lookAt(0,-1,0),o.up.set(0,1,0),o.lookAt(0,0,1),s.up.set(0,1,0),s.lookAt(0,0,-1);else if(e===2001)n.up.set(0,-1,0),n.lookAt(-1,0,0),r.up.set(0,-1,0),r.lookAt(1,0,0),i.up.set(0,0,1),i.lookAt(0,1,0),a.up.set(0,0,-1),a.lookAt(0,-1,0),o.up.set(0,-1,0),o.lookAt(0,0,1),s.up.set(0,-1,0),s.lookAt(0,0,-1);else throw Error(`THREE.CubeCamera.updateCoordinateSystem(): Invalid coordinate system: `+e);for(let e of t)this.add(e),e.updateMatrixWorld()}update(e,t){this.parent===null&&this.updateMatrixWorld();let{renderTarget:n,activeMipmapLevel:r}=this;this.coordinateSystem!==e.coordinateSystem&&(this.coordinateSystem=e.coordinateSystem,this.updateCoordinateSystem());let[i,a,o,s,c,l]=this.children,u=e.getRenderTarget(),d=e.getActiveCubeFace(),f=e.getActiveMipmapLevel(),p=e.xr.enabled;e.xr.enabled=!1;let m=n.texture.mipmapsAutoUpdate;n.texture.mipmapsAutoUpdate=!1;let h=!1;h=e.isWebGLRenderer===!0?e.state.buffers.depth.getReversed():e.reversedDepthBuffer,e.setRenderTarget(n,0,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,i),e.setRenderTarget(n,1,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,a),e.setRenderTarget(n,2,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,o),e.setRenderTarget(n,3,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,s),e.setRenderTarget(n,4,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,c),n.texture.mipmapsAutoUpdate=m,e.setRenderTarget(n,5,r),h&&e.autoClear===!1&&e.clearDepth(),e.render(t,l),e.setRenderTarget(u,d,f),e.xr.enabled=p,n.texture.needsPMREMUpdate=!0}},zb=class extends jb{constructor(e=[]){super(),this.isArrayCamera=!0,this.isMultiViewCamera=!1,this.cameras=e,this.perCameraFrustumCulled=!1}},Bb=`\\[\\]\\.:\\/`,Vb=RegExp(`[\\[\\]\\.:\\/]`,`g`),Hb=`[^\\[\\]\\.:\\/]`,Ub=`[^`+Bb.replace(`\\.`,``)+`]`,Wb=`((?:WC+[\\/:])*)`.replace(`WC`,Hb),Gb=`(WCOD+)?`.replace(`WCOD`,Ub),Kb=`(?:\\.(WC+)(?:\\[(.+)\\])?)?`.replace(`WC`,Hb),qb=`\\.(WC+)(?:\\[(.+)\\])?`.replace(`WC`,Hb),Jb=RegExp(`^`+Wb+Gb+Kb+qb+`$`),Yb=[`material`,`materials`,`bones`,`map`],Xb=class{constructor(e,t,n){let r=n||Zb.parseTrackName(t);this._targetGroup=e,this._bindings=e.subscribe_(t,r)}getValue(e,t){this.bind();let n=this._targetGroup.nCachedObjects_,r=this._bindings[n];r!==void 0&&r.getValue(e,t)}setValue(e,t){let n=this._bindings;for(let r=this._targetGroup.nCachedObjects_,i=n.length;r!==i;++r)n[r].setValue(e,t)}bind(){let e=this._bindings;for(let t=this._targetGroup.nCachedObjects_,n=e.length;t!==n;++t)e[t].bind()}unbind(){let e=this._bindings;for(let t=this._targetGroup.nCachedObjects_,n=e.length;t!==n;++t)e[t].unbind()}},Zb=class e{constructor(t,n,r){this.path=n,this.parsedPath=r||e.parseTrackName(n),this.node=e.findNode(t,this.parsedPath.nodeName),this.rootNode=t,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}static create(t,n,r){return t&&t.isAnimationObjectGroup?new e.Composite(t,n,r):new e(t,n,r)}static sanitizeNodeName(e){return e.replace(/\s/g,`_`).replace(Vb,``)}static parseTrackName(e){let t=Jb.exec(e);if(t===null)throw Error(`THREE.PropertyBinding: Cannot parse trackName: `+e);let n={nodeName:t[2],objectName:t[3],objectIndex:t[4],propertyName:t[5],propertyIndex:t[6]},r=n.nodeName&&n.nodeName.lastIndexOf(`.`);if(r!==void 0&&r!==-1){let e=n.nodeName.substring(r+1);Yb.indexOf(e)!==-1&&(n.nodeName=n.nodeName.substring(0,r),n.objectName=e)}if(n.propertyName===null||n.propertyName.length===0)throw Error(`THREE.PropertyBinding: can not parse propertyName from trackName: `+e);return n}static findNode(e,t){if(t===void 0||t===``||t===`.`||t===-1||t===e.name||t===e.uuid)return e;if(e.skeleton){let n=e.skeleton.getBoneByName(t);if(n!==void 0)return n}if(e.children){let n=function(e){for(let r=0;r<e.length;r++){let i=e[r];if(i.name===t||i.uuid===t)return i;let a=n(i.children);if(a)return a}return null},r=n(e.children);if(r)return r}return null}_getValue_unavailable(){}_setValue_unavailable(){}_getValue_direct(e,t){e[t]=this.targetObject[this.propertyName]}_getValue_array(e,t){let n=this.resolvedProperty;for(let r=0,i=n.length;r!==i;++r)e[t++]=n[r]}_getValue_arrayElement(e,t){e[t]=this.resolvedProperty[this.propertyIndex]}_getValue_toArray(e,t){this.resolvedProperty.toArray(e,t)}_setValue_direct(e,t){this.targetObject[this.propertyName]=e[t]}_setValue_direct_setNeedsUpdate(e,t){this.targetObject[this.propertyName]=e[t],this.targetObject.needsUpdate=!0}_setValue_direct_setMatrixWorldNeedsUpdate(e,t){this.targetObject[this.propertyName]=e[t],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_array(e,t){let n=this.resolvedProperty;for(let r=0,i=n.length;r!==i;++r)n[r]=e[t++]}_setValue_array_setNeedsUpdate(e,t){let n=this.resolvedProperty;for(let r=0,i=n.length;r!==i;++r)n[r]=e[t++];this.targetObject.needsUpdate=!0}_setValue_array_setMatrixWorldNeedsUpdate(e,t){let n=this.resolvedProperty;for(let r=0,i=n.length;r!==i;++r)n[r]=e[t++];this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_arrayElement(e,t){this.resolvedProperty[this.propertyIndex]=e[t]}_setValue_arrayElement_setNeedsUpdate(e,t){this.resolvedProperty[this.propertyIndex]=e[t],this.targetObject.needsUpdate=!0}_setValue_arrayElement_setMatrixWorldNeedsUpdate(e,t){this.resolvedProperty[this.propertyIndex]=e[t],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_fromArray(e,t){this.resolvedProperty.fromArray(e,t)}_setValue_fromArray_setNeedsUpdate(e,t){this.resolvedProperty.fromArray(e,t),this.targetObject.needsUpdate=!0}_setValue_fromArray_setMatrixWorldNeedsUpdate(e,t){this.resolvedProperty.fromArray(e,t),this.targetObject.matrixWorldNeedsUpdate=!0}_getValue_unbound(e,t){this.bind(),this.getValue(e,t)}_setValue_unbound(e,t){this.bind(),this.setValue(e,t)}bind(){let t=this.node,n=this.parsedPath,r=n.objectName,i=n.propertyName,a=n.propertyIndex;if(t||(t=e.findNode(this.rootNode,n.nodeName),this.node=t),this.getValue=this._getValue_unavailable,this.setValue=this._setValue_unavailable,!t){Sm(`PropertyBinding: No target node found for track: `+this.path+`.`);return}if(r){let e=n.objectIndex;switch(r){case`materials`:if(!t.material){Cm(`PropertyBinding: Can not bind to material as node does not have a material.`,this);return}if(!t.material.materials){Cm(`PropertyBinding: Can not bind to material.materials as node.material does not have a materials array.`,this);return}t=t.material.materials;break;case`bones`:if(!t.skeleton){Cm(`PropertyBinding: Can not bind to bones as node does not have a skeleton.`,this);return}t=t.skeleton.bones;for(let n=0;n<t.length;n++)if(t[n].name===e){e=n;break}break;case`map`:if(`map`in t){t=t.map;break}if(!t.material){Cm(`PropertyBinding: Can not bind to material as node does not have a material.`,this);return}if(!t.material.map){Cm(`PropertyBinding: Can not bind to material.map as node.material does not have a map.`,this);return}t=t.material.map;break;default:if(t[r]===void 0){Cm(`PropertyBinding: Can not bind to objectName of node undefined.`,this);return}t=t[r]}if(e!==void 0){if(t[e]===void 0){Cm(`PropertyBinding: Trying to bind to objectIndex of objectName, but is undefined.`,this,t);return}t=t[e]}}let o=t[i];if(o===void 0){let e=n.nodeName;Cm(`PropertyBinding: Trying to update property for track: `+e+`.`+i+` but it wasn't found.`,t);return}let s=this.Versioning.None;this.targetObject=t,t.isMaterial===!0?s=this.Versioning.NeedsUpdate:t.isObject3D===!0&&(s=this.Versioning.MatrixWorldNeedsUpdate);let c=this.BindingType.Direct;if(a!==void 0){if(i===`morphTargetInfluences`){if(!t.geometry){Cm(`PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.`,this);return}if(!t.geometry.morphAttributes){Cm(`PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.morphAttributes.`,this);return}t.morphTargetDictionary[a]!==void 0&&(a=t.morphTargetDictionary[a])}c=this.BindingType.ArrayElement,this.resolvedProperty=o,this.propertyIndex=a}else o.fromArray!==void 0&&o.toArray!==void 0?(c=this.BindingType.HasFromToArray,this.resolvedProperty=o):Array.isArray(o)?(c=this.BindingType.EntireArray,this.resolvedProperty=o):this.propertyName=i;this.getValue=this.GetterByBindingType[c],this.setValue=this.SetterByBindingTypeAndVersioning[c][s]}unbind(){this.node=null,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}};Zb.Composite=Xb,Zb.prototype.BindingType={Direct:0,EntireArray:1,ArrayElement:2,HasFromToArray:3},Zb.prototype.Versioning={None:0,NeedsUpdate:1,MatrixWorldNeedsUpdate:2},Zb.prototype.GetterByBindingType=[Zb.prototype._getValue_direct,Zb.prototype._getValue_array,Zb.prototype._getValue_arrayElement,Zb.prototype._getValue_toArray],Zb.prototype.SetterByBindingTypeAndVersioning=[[Zb.prototype._setValue_direct,Zb.prototype._setValue_direct_setNeedsUpdate,Zb.prototype._setValue_direct_setMatrixWorldNeedsUpdate],[Zb.prototype._setValue_array,Zb.prototype._setValue_array_setNeedsUpdate,Zb.prototype._setValue_array_setMatrixWorldNeedsUpdate],[Zb.prototype._setValue_arrayElement,Zb.prototype._setValue_arrayElement_setNeedsUpdate,Zb.prototype._setValue_arrayElement_setMatrixWorldNeedsUpdate],[Zb.prototype._setValue_fromArray,Zb.prototype._setValue_fromArray_setNeedsUpdate,Zb.prototype._setValue_fromArray_setMatrixWorldNeedsUpdate]];var Qb=new Eh,$b=class{constructor(e,t,n=0,r=1/0){this.ray=new P_(e,t),this.near=n,this.far=r,this.camera=null,this.layers=new Lh,this.params={Mesh:{},Line:{threshold:1},LOD:{},Points:{threshold:1},Sprite:{}}}set(e,t){this.ray.set(e,t)}setFromCamera(e,t){t.isPerspectiveCamera?(this.ray.origin.setFromMatrixPosition(t.matrixWorld),this.ray.direction.set(e.x,e.y,.5).unproject(t).sub(this.ray.origin).normalize(),this.camera=t):t.isOrthographicCamera?(this.ray.origin.set(e.x,e.y,t.projectionMatrix.elements[14]).unproject(t),this.ray.direction.set(0,0,-1).transformDirection(t.matrixWorld),this.camera=t):Cm(`Raycaster: Unsupported camera type: `+t.type)}setFromXRController(e){return Qb.identity().extractRotation(e.matrixWorld),this.ray.origin.setFromMatrixPosition(e.matrixWorld),this.ray.direction.set(0,0,-1).applyMatrix4(Qb),this}intersectObject(e,t=!0,n=[]){return tx(e,this,n,t),n.sort(ex),n}intersectObjects(e,t=!0,n=[]){for(let r=0,i=e.length;r<i;r++)tx(e[r],this,n,t);return n.sort(ex),n}};function ex(e,t){return e.distance-t.distance}function tx(e,t,n,r){let i=!0;if(e.layers.test(t.layers)&&e.raycast(t,n)===!1&&(i=!1),i===!0&&r===!0){let r=e.children;for(let e=0,i=r.length;e<i;e++)tx(r[e],t,n,!0)}}var nx=class{constructor(e=1,t=0,n=0){this.radius=e,this.phi=t,this.theta=n}set(e,t,n){return this.radius=e,this.phi=t,this.theta=n,this}copy(e){return this.radius=e.radius,this.phi=e.phi,this.theta=e.theta,this}makeSafe(){let e=1e-6;return this.phi=Nm(this.phi,e,Math.PI-e),this}setFromVector3(e){return this.setFromCartesianCoords(e.x,e.y,e.z)}setFromCartesianCoords(e,t,n){return this.radius=Math.sqrt(e*e+t*t+n*n),this.radius===0?(this.theta=0,this.phi=0):(this.theta=Math.atan2(e,n),this.phi=Math.acos(Nm(t/this.radius,-1,1))),this}clone(){return new this.constructor().copy(this)}};(class{static{this.prototype.isMatrix2=!0}constructor(e,t,n,r){this.elements=[1,0,0,1],e!==void 0&&this.set(e,t,n,r)}identity(){return this.set(1,0,0,1),this}fromArray(e,t=0){for(let n=0;n<4;n++)this.elements[n]=e[n+t];return this}set(e,t,n,r){let i=this.elements;return i[0]=e,i[2]=t,i[1]=n,i[3]=r,this}});var rx=class extends Dm{constructor(e,t=null){super(),this.object=e,this.domElement=t,this.enabled=!0,this.state=-1,this.keys={},this.mouseButtons={LEFT:null,MIDDLE:null,RIGHT:null},this.touches={ONE:null,TWO:null}}connect(e){this.domElement!==null&&this.disconnect(),this.domElement=e}disconnect(){}dispose(){}update(){}};function ix(e,t,n,r){let i=ax(r);switch(n){case cp:return e*t;case pp:return e*t/i.components*i.byteLength;case mp:return e*t/i.components*i.byteLength;case hp:return e*t*2/i.components*i.byteLength;case gp:return e*t*2/i.components*i.byteLength;case lp:return e*t*3/i.components*i.byteLength;case up:return e*t*4/i.components*i.byteLength;case _p:return e*t*4/i.components*i.byteLength;case vp:case yp:return Math.floor((e+3)/4)*Math.floor((t+3)/4)*8;case bp:case xp:return Math.floor((e+3)/4)*Math.floor((t+3)/4)*16;case Cp:case Tp:return Math.max(e,16)*Math.max(t,8)/4;case Sp:case wp:return Math.max(e,8)*Math.max(t,8)/2;case Ep:case Dp:case kp:case Ap:return Math.floor((e+3)/4)*Math.floor((t+3)/4)*8;case Op:case jp:case Mp:return Math.floor((e+3)/4)*Math.floor((t+3)/4)*16;case Np:return Math.floor((e+3)/4)*Math.floor((t+3)/4)*16;case Pp:return Math.floor((e+4)/5)*Math.floor((t+3)/4)*16;case Fp:return Math.floor((e+4)/5)*Math.floor((t+4)/5)*16;case Ip:return Math.floor((e+5)/6)*Math.floor((t+4)/5)*16;case Lp:return Math.floor((e+5)/6)*Math.floor((t+5)/6)*16;case Rp:return Math.floor((e+7)/8)*Math.floor((t+4)/5)*16;case zp:return Math.floor((e+7)/8)*Math.floor((t+5)/6)*16;case Bp:return Math.floor((e+7)/8)*Math.floor((t+7)/8)*16;case Vp:return Math.floor((e+9)/10)*Math.floor((t+4)/5)*16;case Hp:return Math.floor((e+9)/10)*Math.floor((t+5)/6)*16;case Up:return Math.floor((e+9)/10)*Math.floor((t+7)/8)*16;case Wp:return Math.floor((e+9)/10)*Math.floor((t+9)/10)*16;case Gp:return Math.floor((e+11)/12)*Math.floor((t+9)/10)*16;case Kp:return Math.floor((e+11)/12)*Math.floor((t+11)/12)*16;case qp:case Jp:case Yp:return Math.ceil(e/4)*Math.ceil(t/4)*16;case Xp:case Zp:return Math.ceil(e/4)*Math.ceil(t/4)*8;case Qp:case $p:return Math.ceil(e/4)*Math.ceil(t/4)*16}throw Error(`Unable to determine texture byte length for ${n} format.`)}function ax(e){switch(e){case Yf:case Xf:return{byteLength:1,components:1};case Qf:case Zf:case np:return{byteLength:2,components:1};case rp:case ip:return{byteLength:2,components:4};case ep:case $f:case tp:return{byteLength:4,components:1};case op:case sp:return{byteLength:4,components:3}}throw Error(`THREE.TextureUtils: Unknown texture type ${e}.`)}typeof __THREE_DEVTOOLS__<`u`&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent(`register`,{detail:{revision:`187`}})),typeof window<`u`&&(window.__THREE__?Sm(`WARNING: Multiple instances of Three.js being imported.`):window.__THREE__=`187`);function ox(){let e=null,t=!1,n=null,r=null;function i(t,a){r=e.requestAnimationFrame(i),n(t,a)}return{start:function(){t!==!0&&n!==null&&e!==null&&(r=e.requestAnimationFrame(i),t=!0)},stop:function(){e!==null&&e.cancelAnimationFrame(r),t=!1},setAnimationLoop:function(e){n=e},setContext:function(t){e=t}}}function sx(e){let t=new WeakMap;function n(t,n){let r=t.array,i=t.usage,a=r.byteLength,o=e.createBuffer();e.bindBuffer(n,o),e.bufferData(n,r,i),t.onUploadCallback();let s;if(r instanceof Float32Array)s=e.FLOAT;else if(typeof Float16Array<`u`&&r instanceof Float16Array)s=e.HALF_FLOAT;else if(r instanceof Uint16Array)s=t.isFloat16BufferAttribute?e.HALF_FLOAT:e.UNSIGNED_SHORT;else if(r instanceof Int16Array)s=e.SHORT;else if(r instanceof Uint32Array)s=e.UNSIGNED_INT;else if(r instanceof Int32Array)s=e.INT;else if(r instanceof Int8Array)s=e.BYTE;else if(r instanceof Uint8Array)s=e.UNSIGNED_BYTE;else if(r instanceof Uint8ClampedArray)s=e.UNSIGNED_BYTE;else throw Error(`THREE.WebGLAttributes: Unsupported buffer data format: `+r);return{buffer:o,type:s,bytesPerElement:r.BYTES_PER_ELEMENT,version:t.version,size:a}}function r(t,n,r){let i=n.array,a=n.updateRanges;if(e.bindBuffer(r,t),a.length===0)e.bufferSubData(r,0,i);else{a.sort((e,t)=>e.start-t.start);let t=0;for(let e=1;e<a.length;e++){let n=a[t],r=a[e];r.start<=n.start+n.count+1?n.count=Math.max(n.count,r.start+r.count-n.start):(++t,a[t]=r)}a.length=t+1;for(let t=0,n=a.length;t<n;t++){let n=a[t];e.bufferSubData(r,n.start*i.BYTES_PER_ELEMENT,i,n.start,n.count)}n.clearUpdateRanges()}n.onUploadCallback()}function i(e){return e.isInterleavedBufferAttribute&&(e=e.data),t.get(e)}function a(n){n.isInterleavedBufferAttribute&&(n=n.data);let r=t.get(n);r&&(e.deleteBuffer(r.buffer),t.delete(n))}function o(e,i){if(e.isInterleavedBufferAttribute&&(e=e.data),e.isGLBufferAttribute){let n=t.get(e);(!n||n.version<e.version)&&t.set(e,{buffer:e.buffer,type:e.type,bytesPerElement:e.elementSize,version:e.version});return}let a=t.get(e);if(a===void 0)t.set(e,n(e,i));else if(a.version<e.version){if(a.size!==e.array.byteLength)throw Error(`THREE.WebGLAttributes: The size of the buffer attribute's array buffer does not match the original size. Resizing buffer attributes is not supported.`);r(a.buffer,e,i),a.version=e.version}}return{get:i,remove:a,update:o}}var cx={alphahash_fragment:`#ifdef USE_ALPHAHASH
	if ( diffuseColor.a < getAlphaHashThreshold( vPosition ) ) discard;
#endif`,alphahash_pars_fragment:`#ifdef USE_ALPHAHASH
	const float ALPHA_HASH_SCALE = 0.05;
	float hash2D( vec2 value ) {
		return fract( 1.0e4 * sin( 17.0 * value.x + 0.1 * value.y ) * ( 0.1 + abs( sin( 13.0 * value.y + value.x ) ) ) );
	}
	float hash3D( vec3 value ) {
		return hash2D( vec2( hash2D( value.xy ), value.z ) );
	}
	float getAlphaHashThreshold( vec3 position ) {
		float maxDeriv = max(
			length( dFdx( position.xyz ) ),
			length( dFdy( position.xyz ) )
		);
		float pixScale = 1.0 / ( ALPHA_HASH_SCALE * maxDeriv );
		vec2 pixScales = vec2(
			exp2( floor( log2( pixScale ) ) ),
			exp2( ceil( log2( pixScale ) ) )
		);
		vec2 alpha = vec2(
			hash3D( floor( pixScales.x * position.xyz ) ),
			hash3D( floor( pixScales.y * position.xyz ) )
		);
		float lerpFactor = fract( log2( pixScale ) );
		float x = ( 1.0 - lerpFactor ) * alpha.x + lerpFactor * alpha.y;
		float a = min( lerpFactor, 1.0 - lerpFactor );
		vec3 cases = vec3(
			x * x / ( 2.0 * a * ( 1.0 - a ) ),
			( x - 0.5 * a ) / ( 1.0 - a ),
			1.0 - ( ( 1.0 - x ) * ( 1.0 - x ) / ( 2.0 * a * ( 1.0 - a ) ) )
		);
		float threshold = ( x < ( 1.0 - a ) )
			? ( ( x < a ) ? cases.x : cases.y )
			: cases.z;
		return clamp( threshold , 1.0e-6, 1.0 );
	}
#endif`,alphamap_fragment:`#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, vAlphaMapUv ).g;
#endif`,alphamap_pars_fragment:`#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,alphatest_fragment:`#ifdef USE_ALPHATEST
	#ifdef ALPHA_TO_COVERAGE
	diffuseColor.a = smoothstep( alphaTest, alphaTest + fwidth( diffuseColor.a ), diffuseColor.a );
	if ( diffuseColor.a == 0.0 ) discard;
	#else
	if ( diffuseColor.a < alphaTest ) discard;
	#endif
#endif`,alphatest_pars_fragment:`#ifdef USE_ALPHATEST
	uniform float alphaTest;
#endif`,aomap_fragment:`#ifdef USE_AOMAP
	float ambientOcclusion = ( texture2D( aoMap, vAoMapUv ).r - 1.0 ) * aoMapIntensity + 1.0;
	reflectedLight.indirectDiffuse *= ambientOcclusion;
	#if defined( USE_CLEARCOAT ) 
		clearcoatSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_SHEEN ) 
		sheenSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_ENVMAP ) && defined( STANDARD )
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		reflectedLight.indirectSpecular *= computeSpecularOcclusion( dotNV, ambientOcclusion, material.roughness );
	#endif
#endif`,aomap_pars_fragment:`#ifdef USE_AOMAP
	uniform sampler2D aoMap;
	uniform float aoMapIntensity;
#endif`,batching_pars_vertex:`#ifdef USE_BATCHING
	#if ! defined( GL_ANGLE_multi_draw )
	#define gl_DrawID _gl_DrawID
	uniform int _gl_DrawID;
	#endif
	uniform highp sampler2D batchingTexture;
	uniform highp usampler2D batchingIdTexture;
	mat4 getBatchingMatrix( const in float i ) {
		int size = textureSize( batchingTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( batchingTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( batchingTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( batchingTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( batchingTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
	float getIndirectIndex( const in int i ) {
		int size = textureSize( batchingIdTexture, 0 ).x;
		int x = i % size;
		int y = i / size;
		return float( texelFetch( batchingIdTexture, ivec2( x, y ), 0 ).r );
	}
#endif
#ifdef USE_BATCHING_COLOR
	uniform sampler2D batchingColorTexture;
	vec4 getBatchingColor( const in float i ) {
		int size = textureSize( batchingColorTexture, 0 ).x;
		int j = int( i );
		int x = j % size;
		int y = j / size;
		return texelFetch( batchingColorTexture, ivec2( x, y ), 0 );
	}
#endif`,batching_vertex:`#ifdef USE_BATCHING
	mat4 batchingMatrix = getBatchingMatrix( getIndirectIndex( gl_DrawID ) );
#endif`,begin_vertex:`vec3 transformed = vec3( position );
#ifdef USE_ALPHAHASH
	vPosition = vec3( position );
#endif`,beginnormal_vertex:`vec3 objectNormal = vec3( normal );
#ifdef USE_TANGENT
	vec3 objectTangent = vec3( tangent.xyz );
#endif`,bsdfs:`float G_BlinnPhong_Implicit( ) {
	return 0.25;
}
float D_BlinnPhong( const in float shininess, const in float dotNH ) {
	return RECIPROCAL_PI * ( shininess * 0.5 + 1.0 ) * pow( dotNH, shininess );
}
vec3 BRDF_BlinnPhong( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 specularColor, const in float shininess ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( specularColor, 1.0, dotVH );
	float G = G_BlinnPhong_Implicit( );
	float D = D_BlinnPhong( shininess, dotNH );
	return F * ( G * D );
} // validated`,iridescence_fragment:`#ifdef USE_IRIDESCENCE
	const mat3 XYZ_TO_REC709 = mat3(
		 3.2404542, -0.9692660,  0.0556434,
		-1.5371385,  1.8760108, -0.2040259,
		-0.4985314,  0.0415560,  1.0572252
	);
	vec3 Fresnel0ToIor( vec3 fresnel0 ) {
		vec3 sqrtF0 = sqrt( fresnel0 );
		return ( vec3( 1.0 ) + sqrtF0 ) / ( vec3( 1.0 ) - sqrtF0 );
	}
	vec3 IorToFresnel0( vec3 transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - vec3( incidentIor ) ) / ( transmittedIor + vec3( incidentIor ) ) );
	}
	float IorToFresnel0( float transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - incidentIor ) / ( transmittedIor + incidentIor ));
	}
	vec3 evalSensitivity( float OPD, vec3 shift ) {
		float phase = 2.0 * PI * OPD * 1.0e-9;
		vec3 val = vec3( 5.4856e-13, 4.4201e-13, 5.2481e-13 );
		vec3 pos = vec3( 1.6810e+06, 1.7953e+06, 2.2084e+06 );
		vec3 var = vec3( 4.3278e+09, 9.3046e+09, 6.6121e+09 );
		vec3 xyz = val * sqrt( 2.0 * PI * var ) * cos( pos * phase + shift ) * exp( - pow2( phase ) * var );
		xyz.x += 9.7470e-14 * sqrt( 2.0 * PI * 4.5282e+09 ) * cos( 2.2399e+06 * phase + shift[ 0 ] ) * exp( - 4.5282e+09 * pow2( phase ) );
		xyz /= 1.0685e-7;
		vec3 rgb = XYZ_TO_REC709 * xyz;
		return rgb;
	}
	vec3 evalIridescence( float outsideIOR, float eta2, float cosTheta1, float thinFilmThickness, vec3 baseF0 ) {
		vec3 I;
		float iridescenceIOR = mix( outsideIOR, eta2, smoothstep( 0.0, 0.03, thinFilmThickness ) );
		float sinTheta2Sq = pow2( outsideIOR / iridescenceIOR ) * ( 1.0 - pow2( cosTheta1 ) );
		float cosTheta2Sq = 1.0 - sinTheta2Sq;
		if ( cosTheta2Sq < 0.0 ) {
			return vec3( 1.0 );
		}
		float cosTheta2 = sqrt( cosTheta2Sq );
		float R0 = IorToFresnel0( iridescenceIOR, outsideIOR );
		float R12 = F_Schlick( R0, 1.0, cosTheta1 );
		float T121 = 1.0 - R12;
		float phi12 = 0.0;
		if ( iridescenceIOR < outsideIOR ) phi12 = PI;
		float phi21 = PI - phi12;
		vec3 baseIOR = Fresnel0ToIor( clamp( baseF0, 0.0, 0.9999 ) );		vec3 R1 = IorToFresnel0( baseIOR, iridescenceIOR );
		vec3 R23 = F_Schlick( R1, 1.0, cosTheta2 );
		vec3 phi23 = vec3( 0.0 );
		if ( baseIOR[ 0 ] < iridescenceIOR ) phi23[ 0 ] = PI;
		if ( baseIOR[ 1 ] < iridescenceIOR ) phi23[ 1 ] = PI;
		if ( baseIOR[ 2 ] < iridescenceIOR ) phi23[ 2 ] = PI;
		float OPD = 2.0 * iridescenceIOR * thinFilmThickness * cosTheta2;
		vec3 phi = vec3( phi21 ) + phi23;
		vec3 R123 = clamp( R12 * R23, 1e-5, 0.9999 );
		vec3 r123 = sqrt( R123 );
		vec3 Rs = pow2( T121 ) * R23 / ( vec3( 1.0 ) - R123 );
		vec3 C0 = R12 + Rs;
		I = C0;
		vec3 Cm = Rs - T121;
		for ( int m = 1; m <= 2; ++ m ) {
			Cm *= r123;
			vec3 Sm = 2.0 * evalSensitivity( float( m ) * OPD, float( m ) * phi );
			I += Cm * Sm;
		}
		return max( I, vec3( 0.0 ) );
	}
#endif`,bumpmap_pars_fragment:`#ifdef USE_BUMPMAP
	uniform sampler2D bumpMap;
	uniform float bumpScale;
	vec2 dHdxy_fwd() {
		vec2 dSTdx = dFdx( vBumpMapUv );
		vec2 dSTdy = dFdy( vBumpMapUv );
		float Hll = bumpScale * texture2D( bumpMap, vBumpMapUv ).x;
		float dBx = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdx ).x - Hll;
		float dBy = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdy ).x - Hll;
		return vec2( dBx, dBy );
	}
	vec3 perturbNormalArb( vec3 surf_pos, vec3 surf_norm, vec2 dHdxy, float faceDirection ) {
		vec3 vSigmaX = normalize( dFdx( surf_pos.xyz ) );
		vec3 vSigmaY = normalize( dFdy( surf_pos.xyz ) );
		vec3 vN = surf_norm;
		vec3 R1 = cross( vSigmaY, vN );
		vec3 R2 = cross( vN, vSigmaX );
		float fDet = dot( vSigmaX, R1 ) * faceDirection;
		vec3 vGrad = sign( fDet ) * ( dHdxy.x * R1 + dHdxy.y * R2 );
		return normalize( abs( fDet ) * surf_norm - vGrad );
	}
#endif`,clipping_planes_fragment:`#if NUM_CLIPPING_PLANES > 0
	vec4 plane;
	#ifdef ALPHA_TO_COVERAGE
		float distanceToPlane, distanceGradient;
		float clipOpacity = 1.0;
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
			distanceGradient = fwidth( distanceToPlane ) / 2.0;
			clipOpacity *= smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			if ( clipOpacity == 0.0 ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			float unionClipOpacity = 1.0;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
				distanceGradient = fwidth( distanceToPlane ) / 2.0;
				unionClipOpacity *= 1.0 - smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			}
			#pragma unroll_loop_end
			clipOpacity *= 1.0 - unionClipOpacity;
		#endif
		diffuseColor.a *= clipOpacity;
		if ( diffuseColor.a == 0.0 ) discard;
	#else
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			if ( dot( vClipPosition, plane.xyz ) > plane.w ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			bool clipped = true;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				clipped = ( dot( vClipPosition, plane.xyz ) > plane.w ) && clipped;
			}
			#pragma unroll_loop_end
			if ( clipped ) discard;
		#endif
	#endif
#endif`,clipping_planes_pars_fragment:`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
	uniform vec4 clippingPlanes[ NUM_CLIPPING_PLANES ];
#endif`,clipping_planes_pars_vertex:`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
#endif`,clipping_planes_vertex:`#if NUM_CLIPPING_PLANES > 0
	vClipPosition = - mvPosition.xyz;
#endif`,color_fragment:`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	diffuseColor *= vColor;
#endif`,color_pars_fragment:`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA )
	varying vec4 vColor;
#endif`,color_pars_vertex:`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	varying vec4 vColor;
#endif`,color_vertex:`#if defined( USE_COLOR ) || defined( USE_COLOR_ALPHA ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	vColor = vec4( 1.0 );
#endif
#ifdef USE_COLOR_ALPHA
	vColor *= color;
#elif defined( USE_COLOR )
	vColor.rgb *= color;
#endif
#ifdef USE_INSTANCING_COLOR
	vColor.rgb *= instanceColor.rgb;
#endif
#ifdef USE_BATCHING_COLOR
	vColor *= getBatchingColor( getIndirectIndex( gl_DrawID ) );
#endif`,common:`#define PI 3.141592653589793
#define PI2 6.283185307179586
#define PI_HALF 1.5707963267948966
#define RECIPROCAL_PI 0.3183098861837907
#define RECIPROCAL_PI2 0.15915494309189535
#define EPSILON 1e-6
#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
#define whiteComplement( a ) ( 1.0 - saturate( a ) )
float pow2( const in float x ) { return x*x; }
vec3 pow2( const in vec3 x ) { return x*x; }
float pow3( const in float x ) { return x*x*x; }
float pow4( const in float x ) { float x2 = x*x; return x2*x2; }
float max3( const in vec3 v ) { return max( max( v.x, v.y ), v.z ); }
float average( const in vec3 v ) { return dot( v, vec3( 0.3333333 ) ); }
highp float rand( const in vec2 uv ) {
	const highp float a = 12.9898, b = 78.233, c = 43758.5453;
	highp float dt = dot( uv.xy, vec2( a,b ) ), sn = mod( dt, PI );
	return fract( sin( sn ) * c );
}
#ifdef HIGH_PRECISION
	float precisionSafeLength( vec3 v ) { return length( v ); }
#else
	float precisionSafeLength( vec3 v ) {
		float maxComponent = max3( abs( v ) );
		return length( v / maxComponent ) * maxComponent;
	}
#endif
struct IncidentLight {
	vec3 color;
	vec3 direction;
	bool visible;
};
struct ReflectedLight {
	vec3 directDiffuse;
	vec3 directSpecular;
	vec3 indirectDiffuse;
	vec3 indirectSpecular;
};
#ifdef USE_ALPHAHASH
	varying vec3 vPosition;
#endif
vec3 transformDirection( in vec3 dir, in mat4 matrix ) {
	return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );
}
#define inverseTransformDirection transformDirectionByInverseViewMatrix
vec3 transformNormalByInverseViewMatrix( in vec3 normal, in mat4 viewMatrix ) {
	return normalize( ( vec4( normal, 0.0 ) * viewMatrix ).xyz );
}
vec3 transformDirectionByInverseViewMatrix( in vec3 dir, in mat4 viewMatrix ) {
	return normalize( ( vec4( dir, 0.0 ) * viewMatrix ).xyz );
}
bool isPerspectiveMatrix( mat4 m ) {
	return m[ 2 ][ 3 ] == - 1.0;
}
vec2 equirectUv( in vec3 dir ) {
	float u = atan( dir.z, dir.x ) * RECIPROCAL_PI2 + 0.5;
	float v = asin( clamp( dir.y, - 1.0, 1.0 ) ) * RECIPROCAL_PI + 0.5;
	return vec2( u, v );
}
vec3 BRDF_Lambert( const in vec3 diffuseColor ) {
	return RECIPROCAL_PI * diffuseColor;
}
vec3 F_Schlick( const in vec3 f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
}
float F_Schlick( const in float f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
} // validated`,defaultnormal_vertex:`vec3 transformedNormal = objectNormal;
#ifdef USE_TANGENT
	vec3 transformedTangent = objectTangent;
#endif
#ifdef USE_BATCHING
	mat3 bm = mat3( batchingMatrix );
	transformedNormal /= vec3( dot( bm[ 0 ], bm[ 0 ] ), dot( bm[ 1 ], bm[ 1 ] ), dot( bm[ 2 ], bm[ 2 ] ) );
	transformedNormal = bm * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = bm * transformedTangent;
	#endif
#endif
#ifdef USE_INSTANCING
	mat3 im = mat3( instanceMatrix );
	transformedNormal /= vec3( dot( im[ 0 ], im[ 0 ] ), dot( im[ 1 ], im[ 1 ] ), dot( im[ 2 ], im[ 2 ] ) );
	transformedNormal = im * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = im * transformedTangent;
	#endif
#endif
transformedNormal = normalMatrix * transformedNormal;
#ifdef FLIP_SIDED
	transformedNormal = - transformedNormal;
#endif
#ifdef USE_TANGENT
	transformedTangent = ( modelViewMatrix * vec4( transformedTangent, 0.0 ) ).xyz;
#endif`,displacementmap_pars_vertex:`#ifdef USE_DISPLACEMENTMAP
	uniform sampler2D displacementMap;
	uniform float displacementScale;
	uniform float displacementBias;
#endif`,displacementmap_vertex:`#ifdef USE_DISPLACEMENTMAP
	transformed += normalize( objectNormal ) * ( texture2D( displacementMap, vDisplacementMapUv ).x * displacementScale + displacementBias );
#endif`,emissivemap_fragment:`#ifdef USE_EMISSIVEMAP
	vec4 emissiveColor = texture2D( emissiveMap, vEmissiveMapUv );
	#ifdef DECODE_VIDEO_TEXTURE_EMISSIVE
		emissiveColor = sRGBTransferEOTF( emissiveColor );
	#endif
	totalEmissiveRadiance *= emissiveColor.rgb;
#endif`,emissivemap_pars_fragment:`#ifdef USE_EMISSIVEMAP
	uniform sampler2D emissiveMap;
#endif`,colorspace_fragment:`gl_FragColor = linearToOutputTexel( gl_FragColor );`,colorspace_pars_fragment:`vec4 LinearTransferOETF( in vec4 value ) {
	return value;
}
vec4 sRGBTransferEOTF( in vec4 value ) {
	return vec4( mix( pow( value.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), value.rgb * 0.0773993808, vec3( lessThanEqual( value.rgb, vec3( 0.04045 ) ) ) ), value.a );
}
vec4 sRGBTransferOETF( in vec4 value ) {
	return vec4( mix( pow( value.rgb, vec3( 0.41666 ) ) * 1.055 - vec3( 0.055 ), value.rgb * 12.92, vec3( lessThanEqual( value.rgb, vec3( 0.0031308 ) ) ) ), value.a );
}`,envmap_fragment:`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vec3 cameraToFrag;
		if ( isOrthographic ) {
			cameraToFrag = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToFrag = normalize( vWorldPosition - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vec3 reflectVec = reflect( cameraToFrag, worldNormal );
		#else
			vec3 reflectVec = refract( cameraToFrag, worldNormal, refractionRatio );
		#endif
	#else
		vec3 reflectVec = vReflect;
	#endif
	#ifdef ENVMAP_TYPE_CUBE
		vec4 envColor = textureCube( envMap, envMapRotation * reflectVec );
		#ifdef ENVMAP_BLENDING_MULTIPLY
			outgoingLight = mix( outgoingLight, outgoingLight * envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_MIX )
			outgoingLight = mix( outgoingLight, envColor.xyz, specularStrength * reflectivity );
		#elif defined( ENVMAP_BLENDING_ADD )
			outgoingLight += envColor.xyz * specularStrength * reflectivity;
		#endif
	#endif
#endif`,envmap_common_pars_fragment:`#ifdef USE_ENVMAP
	uniform float envMapIntensity;
	uniform mat3 envMapRotation;
	uniform samplerCube envMap;
	#ifdef ENVMAP_TYPE_PMREM
		float roughnessToMip( const in float roughness ) {
			float r = clamp( roughness, 0.0, 1.0 );
			return ENVMAP_MAX_LOD * r * ( 2.0 - r );
		}
	#endif
#endif`,envmap_pars_fragment:`#ifdef USE_ENVMAP
	uniform float reflectivity;
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		varying vec3 vWorldPosition;
		uniform float refractionRatio;
	#else
		varying vec3 vReflect;
	#endif
#endif`,envmap_pars_vertex:`#ifdef USE_ENVMAP
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		
		varying vec3 vWorldPosition;
	#else
		varying vec3 vReflect;
		uniform float refractionRatio;
	#endif
#endif`,envmap_physical_pars_fragment:`#ifdef USE_ENVMAP
	vec3 getIBLIrradiance( const in vec3 normal ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * worldNormal, ENVMAP_MAX_LOD );
			return PI * envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	vec3 getIBLRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
		#ifdef ENVMAP_TYPE_PMREM
			vec3 reflectVec = reflect( - viewDir, normal );
			reflectVec = normalize( mix( reflectVec, normal, pow4( roughness ) ) );
			reflectVec = transformDirectionByInverseViewMatrix( reflectVec, viewMatrix );
			vec4 envMapColor = textureLod( envMap, envMapRotation * reflectVec, roughnessToMip( roughness ) );
			return envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	#ifdef USE_RETROREFLECTION
		vec3 getIBLRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 retroVec = normalize( mix( viewDir, normal, pow4( roughness ) ) );
				retroVec = transformDirectionByInverseViewMatrix( retroVec, viewMatrix );
				vec4 envMapColor = textureLod( envMap, envMapRotation * retroVec, roughnessToMip( roughness ) );
				return envMapColor.rgb * envMapIntensity;
			#else
				return vec3( 0.0 );
			#endif
		}
	#endif
	#ifdef USE_ANISOTROPY
		vec3 getIBLAnisotropyRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
			#ifdef ENVMAP_TYPE_PMREM
				vec3 bentNormal = cross( bitangent, viewDir );
				bentNormal = normalize( cross( bentNormal, bitangent ) );
				bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
				return getIBLRadiance( viewDir, bentNormal, roughness );
			#else
				return vec3( 0.0 );
			#endif
		}
		#ifdef USE_RETROREFLECTION
			vec3 getIBLAnisotropyRetroRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
				#ifdef ENVMAP_TYPE_PMREM
					vec3 bentNormal = cross( bitangent, viewDir );
					bentNormal = normalize( cross( bentNormal, bitangent ) );
					bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
					return getIBLRetroRadiance( viewDir, bentNormal, roughness );
				#else
					return vec3( 0.0 );
				#endif
			}
		#endif
	#endif
#endif`,envmap_vertex:`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vWorldPosition = worldPosition.xyz;
	#else
		vec3 cameraToVertex;
		if ( isOrthographic ) {
			cameraToVertex = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToVertex = normalize( worldPosition.xyz - cameraPosition );
		}
		vec3 worldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vReflect = reflect( cameraToVertex, worldNormal );
		#else
			vReflect = refract( cameraToVertex, worldNormal, refractionRatio );
		#endif
	#endif
#endif`,fog_vertex:`#ifdef USE_FOG
	vFogDepth = - mvPosition.z;
#endif`,fog_pars_vertex:`#ifdef USE_FOG
	varying float vFogDepth;
#endif`,fog_fragment:`#ifdef USE_FOG
	#ifdef FOG_EXP2
		float fogFactor = 1.0 - exp( - fogDensity * fogDensity * vFogDepth * vFogDepth );
	#else
		float fogFactor = smoothstep( fogNear, fogFar, vFogDepth );
	#endif
	gl_FragColor.rgb = mix( gl_FragColor.rgb, fogColor, fogFactor );
#endif`,fog_pars_fragment:`#ifdef USE_FOG
	uniform vec3 fogColor;
	varying float vFogDepth;
	#ifdef FOG_EXP2
		uniform float fogDensity;
	#else
		uniform float fogNear;
		uniform float fogFar;
	#endif
#endif`,gradientmap_pars_fragment:`#ifdef USE_GRADIENTMAP
	uniform sampler2D gradientMap;
#endif
vec3 getGradientIrradiance( vec3 normal, vec3 lightDirection ) {
	float dotNL = dot( normal, lightDirection );
	vec2 coord = vec2( dotNL * 0.5 + 0.5, 0.0 );
	#ifdef USE_GRADIENTMAP
		return vec3( texture2D( gradientMap, coord ).r );
	#else
		vec2 fw = fwidth( coord ) * 0.5;
		return mix( vec3( 0.7 ), vec3( 1.0 ), smoothstep( 0.7 - fw.x, 0.7 + fw.x, coord.x ) );
	#endif
}`,lightmap_pars_fragment:`#ifdef USE_LIGHTMAP
	uniform sampler2D lightMap;
	uniform float lightMapIntensity;
#endif`,lights_lambert_fragment:`LambertMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularStrength = specularStrength;`,lights_lambert_pars_fragment:`varying vec3 vViewPosition;
struct LambertMaterial {
	vec3 diffuseColor;
	float specularStrength;
};
void RE_Direct_Lambert( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Lambert( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Lambert
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Lambert`,lights_pars_begin:`uniform bool receiveShadow;
uniform vec3 ambientLightColor;
#if defined( USE_LIGHT_PROBES )
	uniform vec3 lightProbe[ 9 ];
#endif
vec3 shGetIrradianceAt( in vec3 normal, in vec3 shCoefficients[ 9 ] ) {
	float x = normal.x, y = normal.y, z = normal.z;
	vec3 result = shCoefficients[ 0 ] * 0.886227;
	result += shCoefficients[ 1 ] * 2.0 * 0.511664 * y;
	result += shCoefficients[ 2 ] * 2.0 * 0.511664 * z;
	result += shCoefficients[ 3 ] * 2.0 * 0.511664 * x;
	result += shCoefficients[ 4 ] * 2.0 * 0.429043 * x * y;
	result += shCoefficients[ 5 ] * 2.0 * 0.429043 * y * z;
	result += shCoefficients[ 6 ] * ( 0.743125 * z * z - 0.247708 );
	result += shCoefficients[ 7 ] * 2.0 * 0.429043 * x * z;
	result += shCoefficients[ 8 ] * 0.429043 * ( x * x - y * y );
	return result;
}
vec3 getLightProbeIrradiance( const in vec3 lightProbe[ 9 ], const in vec3 normal ) {
	vec3 worldNormal = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec3 irradiance = shGetIrradianceAt( worldNormal, lightProbe );
	return irradiance;
}
vec3 getAmbientLightIrradiance( const in vec3 ambientLightColor ) {
	vec3 irradiance = ambientLightColor;
	return irradiance;
}
float getDistanceAttenuation( const in float lightDistance, const in float cutoffDistance, const in float decayExponent ) {
	float distanceFalloff = 1.0 / max( pow( lightDistance, decayExponent ), 0.01 );
	if ( cutoffDistance > 0.0 ) {
		distanceFalloff *= pow2( saturate( 1.0 - pow4( lightDistance / cutoffDistance ) ) );
	}
	return distanceFalloff;
}
float getSpotAttenuation( const in float coneCosine, const in float penumbraCosine, const in float angleCosine ) {
	return smoothstep( coneCosine, penumbraCosine, angleCosine );
}
#if NUM_SUN_LIGHTS > 0
	struct SunLight {
		vec3 direction;
		vec3 color;
	};
	uniform SunLight sunLights[ NUM_SUN_LIGHTS ];
	void getSunLightInfo( const in SunLight sunLight, out IncidentLight light ) {
		light.color = sunLight.color;
		light.direction = sunLight.direction;
		light.visible = true;
	}
#endif
#if NUM_DIR_LIGHTS > 0
	struct DirectionalLight {
		vec3 direction;
		vec3 color;
	};
	uniform DirectionalLight directionalLights[ NUM_DIR_LIGHTS ];
	void getDirectionalLightInfo( const in DirectionalLight directionalLight, out IncidentLight light ) {
		light.color = directionalLight.color;
		light.direction = directionalLight.direction;
		light.visible = true;
	}
#endif
#if NUM_POINT_LIGHTS > 0
	struct PointLight {
		vec3 position;
		vec3 color;
		float distance;
		float decay;
	};
	uniform PointLight pointLights[ NUM_POINT_LIGHTS ];
	void getPointLightInfo( const in PointLight pointLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = pointLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float lightDistance = length( lVector );
		light.color = pointLight.color;
		light.color *= getDistanceAttenuation( lightDistance, pointLight.distance, pointLight.decay );
		light.visible = ( light.color != vec3( 0.0 ) );
	}
#endif
#if NUM_SPOT_LIGHTS > 0
	struct SpotLight {
		vec3 position;
		vec3 direction;
		vec3 color;
		float distance;
		float decay;
		float coneCos;
		float penumbraCos;
	};
	uniform SpotLight spotLights[ NUM_SPOT_LIGHTS ];
	void getSpotLightInfo( const in SpotLight spotLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = spotLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float angleCos = dot( light.direction, spotLight.direction );
		float spotAttenuation = getSpotAttenuation( spotLight.coneCos, spotLight.penumbraCos, angleCos );
		if ( spotAttenuation > 0.0 ) {
			float lightDistance = length( lVector );
			light.color = spotLight.color * spotAttenuation;
			light.color *= getDistanceAttenuation( lightDistance, spotLight.distance, spotLight.decay );
			light.visible = ( light.color != vec3( 0.0 ) );
		} else {
			light.color = vec3( 0.0 );
			light.visible = false;
		}
	}
#endif
#if NUM_RECT_AREA_LIGHTS > 0
	struct RectAreaLight {
		vec3 color;
		vec3 position;
		vec3 halfWidth;
		vec3 halfHeight;
	};
	uniform sampler2D ltc_1;	uniform sampler2D ltc_2;
	uniform RectAreaLight rectAreaLights[ NUM_RECT_AREA_LIGHTS ];
#endif
#if NUM_HEMI_LIGHTS > 0
	struct HemisphereLight {
		vec3 direction;
		vec3 skyColor;
		vec3 groundColor;
	};
	uniform HemisphereLight hemisphereLights[ NUM_HEMI_LIGHTS ];
	vec3 getHemisphereLightIrradiance( const in HemisphereLight hemiLight, const in vec3 normal ) {
		float dotNL = dot( normal, hemiLight.direction );
		float hemiDiffuseWeight = 0.5 * dotNL + 0.5;
		vec3 irradiance = mix( hemiLight.groundColor, hemiLight.skyColor, hemiDiffuseWeight );
		return irradiance;
	}
#endif
#include <lightprobes_pars_fragment>`,lights_toon_fragment:`ToonMaterial material;
material.diffuseColor = diffuseColor.rgb;`,lights_toon_pars_fragment:`varying vec3 vViewPosition;
struct ToonMaterial {
	vec3 diffuseColor;
};
void RE_Direct_Toon( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 irradiance = getGradientIrradiance( geometryNormal, directLight.direction ) * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Toon( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Toon
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Toon`,lights_phong_fragment:`BlinnPhongMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularColor = specular;
material.specularShininess = shininess;
material.specularStrength = specularStrength;`,lights_phong_pars_fragment:`varying vec3 vViewPosition;
struct BlinnPhongMaterial {
	vec3 diffuseColor;
	vec3 specularColor;
	float specularShininess;
	float specularStrength;
};
void RE_Direct_BlinnPhong( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
	reflectedLight.directSpecular += irradiance * BRDF_BlinnPhong( directLight.direction, geometryViewDir, geometryNormal, material.specularColor, material.specularShininess ) * material.specularStrength;
}
void RE_IndirectDiffuse_BlinnPhong( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_BlinnPhong
#define RE_IndirectDiffuse		RE_IndirectDiffuse_BlinnPhong`,lights_physical_fragment:`PhysicalMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.diffuseContribution = diffuseColor.rgb * ( 1.0 - metalnessFactor );
material.metalness = metalnessFactor;
vec3 dxy = max( abs( dFdx( nonPerturbedNormal ) ), abs( dFdy( nonPerturbedNormal ) ) );
float geometryRoughness = max( max( dxy.x, dxy.y ), dxy.z );
material.roughness = max( roughnessFactor, 0.045 );
material.roughness += geometryRoughness;
material.roughness = min( material.roughness, 1.0 );
#ifdef USE_DIFFUSE_ROUGHNESS
	float diffuseRoughnessFactor = diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		diffuseRoughnessFactor *= texture2D( diffuseRoughnessMap, vDiffuseRoughnessMapUv ).r;
	#endif
	material.diffuseRoughness = saturate( diffuseRoughnessFactor );
#endif
#ifdef IOR
	material.ior = ior;
	#ifdef USE_SPECULAR
		float specularIntensityFactor = specularIntensity;
		vec3 specularColorFactor = specularColor;
		#ifdef USE_SPECULAR_COLORMAP
			specularColorFactor *= texture2D( specularColorMap, vSpecularColorMapUv ).rgb;
		#endif
		#ifdef USE_SPECULAR_INTENSITYMAP
			specularIntensityFactor *= texture2D( specularIntensityMap, vSpecularIntensityMapUv ).a;
		#endif
		material.specularF90 = mix( specularIntensityFactor, 1.0, metalnessFactor );
	#else
		float specularIntensityFactor = 1.0;
		vec3 specularColorFactor = vec3( 1.0 );
		material.specularF90 = 1.0;
	#endif
	material.specularColor = min( pow2( ( material.ior - 1.0 ) / ( material.ior + 1.0 ) ) * specularColorFactor, vec3( 1.0 ) ) * specularIntensityFactor;
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
#else
	material.specularColor = vec3( 0.04 );
	material.specularColorBlended = mix( material.specularColor, diffuseColor.rgb, metalnessFactor );
	material.specularF90 = 1.0;
#endif
#ifdef USE_CLEARCOAT
	material.clearcoat = clearcoat;
	material.clearcoatRoughness = clearcoatRoughness;
	material.clearcoatF0 = vec3( 0.04 );
	material.clearcoatF90 = 1.0;
	#ifdef USE_CLEARCOATMAP
		material.clearcoat *= texture2D( clearcoatMap, vClearcoatMapUv ).x;
	#endif
	#ifdef USE_CLEARCOAT_ROUGHNESSMAP
		material.clearcoatRoughness *= texture2D( clearcoatRoughnessMap, vClearcoatRoughnessMapUv ).y;
	#endif
	material.clearcoat = saturate( material.clearcoat );	material.clearcoatRoughness = max( material.clearcoatRoughness, 0.045 );
	material.clearcoatRoughness += geometryRoughness;
	material.clearcoatRoughness = min( material.clearcoatRoughness, 1.0 );
#endif
#ifdef USE_DISPERSION
	material.dispersion = dispersion;
#endif
#ifdef USE_RETROREFLECTION
	material.retroreflectivity = retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	material.iridescence = iridescence;
	material.iridescenceIOR = iridescenceIOR;
	#ifdef USE_IRIDESCENCEMAP
		material.iridescence *= texture2D( iridescenceMap, vIridescenceMapUv ).r;
	#endif
	#ifdef USE_IRIDESCENCE_THICKNESSMAP
		material.iridescenceThickness = (iridescenceThicknessMaximum - iridescenceThicknessMinimum) * texture2D( iridescenceThicknessMap, vIridescenceThicknessMapUv ).g + iridescenceThicknessMinimum;
	#else
		material.iridescenceThickness = iridescenceThicknessMaximum;
	#endif
#endif
#ifdef USE_SHEEN
	material.sheenColor = sheenColor;
	#ifdef USE_SHEEN_COLORMAP
		material.sheenColor *= texture2D( sheenColorMap, vSheenColorMapUv ).rgb;
	#endif
	material.sheenRoughness = clamp( sheenRoughness, 0.0001, 1.0 );
	#ifdef USE_SHEEN_ROUGHNESSMAP
		material.sheenRoughness *= texture2D( sheenRoughnessMap, vSheenRoughnessMapUv ).a;
	#endif
#endif
#ifdef USE_ANISOTROPY
	#ifdef USE_ANISOTROPYMAP
		mat2 anisotropyMat = mat2( anisotropyVector.x, anisotropyVector.y, - anisotropyVector.y, anisotropyVector.x );
		vec3 anisotropyPolar = texture2D( anisotropyMap, vAnisotropyMapUv ).rgb;
		vec2 anisotropyV = anisotropyMat * normalize( 2.0 * anisotropyPolar.rg - vec2( 1.0 ) ) * anisotropyPolar.b;
	#else
		vec2 anisotropyV = anisotropyVector;
	#endif
	material.anisotropy = length( anisotropyV );
	if( material.anisotropy == 0.0 ) {
		anisotropyV = vec2( 1.0, 0.0 );
	} else {
		anisotropyV /= material.anisotropy;
		material.anisotropy = saturate( material.anisotropy );
	}
	material.alphaT = mix( pow2( material.roughness ), 1.0, pow2( material.anisotropy ) );
	material.anisotropyT = tbn[ 0 ] * anisotropyV.x + tbn[ 1 ] * anisotropyV.y;
	material.anisotropyB = tbn[ 1 ] * anisotropyV.x - tbn[ 0 ] * anisotropyV.y;
#endif`,lights_physical_pars_fragment:`uniform sampler2D dfgLUT;
struct PhysicalMaterial {
	vec3 diffuseColor;
	vec3 diffuseContribution;
	vec3 specularColor;
	vec3 specularColorBlended;
	float roughness;
	float metalness;
	float specularF90;
	float dispersion;
	vec2 dfg;
	vec3 multiScatteringCompensation;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float diffuseRoughness;
	#endif
	#ifdef USE_RETROREFLECTION
		float retroreflectivity;
	#endif
	#ifdef USE_CLEARCOAT
		float clearcoat;
		float clearcoatRoughness;
		vec3 clearcoatF0;
		float clearcoatF90;
	#endif
	#ifdef USE_IRIDESCENCE
		float iridescence;
		float iridescenceIOR;
		float iridescenceThickness;
		vec3 iridescenceFresnel;
		vec3 iridescenceF0Dielectric;
		vec3 iridescenceF0Metallic;
	#endif
	#ifdef USE_SHEEN
		vec3 sheenColor;
		float sheenRoughness;
	#endif
	#ifdef IOR
		float ior;
	#endif
	#ifdef USE_TRANSMISSION
		float transmission;
		float transmissionAlpha;
		float thickness;
		float attenuationDistance;
		vec3 attenuationColor;
	#endif
	#ifdef USE_ANISOTROPY
		float anisotropy;
		float alphaT;
		vec3 anisotropyT;
		vec3 anisotropyB;
	#endif
};
vec3 clearcoatSpecularDirect = vec3( 0.0 );
vec3 clearcoatSpecularIndirect = vec3( 0.0 );
vec3 sheenSpecularDirect = vec3( 0.0 );
vec3 sheenSpecularIndirect = vec3(0.0 );
vec3 Schlick_to_F0( const in vec3 f, const in float f90, const in float dotVH ) {
    float x = clamp( 1.0 - dotVH, 0.0, 1.0 );
    float x2 = x * x;
    float x5 = clamp( x * x2 * x2, 0.0, 0.9999 );
    return ( f - vec3( f90 ) * x5 ) / ( 1.0 - x5 );
}
#ifdef USE_DIFFUSE_ROUGHNESS
	const float EON_EPSILON = 1e-7;
	float FON_DirectionalAlbedo( const in float mu, const in float roughness, const in float A ) {
		float muComp = 1.0 - mu;
		float gOverPi = muComp * ( 0.0571085289 + muComp * ( 0.491881867 + muComp * ( - 0.332181442 + muComp * 0.0714429953 ) ) );
		return A * ( 1.0 + roughness * gOverPi );
	}
	vec3 BRDF_EON( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 diffuseColor, const in float roughness ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return BRDF_Lambert( rho );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float s = dot( lightDir, viewDir ) - dotNL * dotNV;
		float sOverT = ( s > 0.0 ) ? s / max( max( dotNL, dotNV ), EON_EPSILON ) : s;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		vec3 singleScatter = rho * RECIPROCAL_PI * A * ( 1.0 + roughness * sOverT );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		float albedoV = FON_DirectionalAlbedo( dotNV, roughness, A );
		float albedoL = FON_DirectionalAlbedo( dotNL, roughness, A );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		vec3 multiScatter = rhoMultiScatter * RECIPROCAL_PI
			* max( EON_EPSILON, 1.0 - albedoV )
			* max( EON_EPSILON, 1.0 - albedoL )
			/ max( EON_EPSILON, 1.0 - averageAlbedo );
		return singleScatter + multiScatter;
	}
	vec3 EON_DirectionalAlbedo( const in vec3 diffuseColor, const in float roughness, const in float dotNV ) {
		vec3 rho = saturate( diffuseColor );
		if ( roughness <= EON_EPSILON ) return rho;
		float A = 1.0 / ( 1.0 + ( 0.5 - 2.0 / ( 3.0 * PI ) ) * roughness );
		float directionalAlbedo = FON_DirectionalAlbedo( dotNV, roughness, A );
		float averageAlbedo = A * ( 1.0 + ( 2.0 / 3.0 - 28.0 / ( 15.0 * PI ) ) * roughness );
		vec3 rhoMultiScatter = rho * rho * averageAlbedo / max( vec3( EON_EPSILON ), vec3( 1.0 ) - rho * ( 1.0 - averageAlbedo ) );
		return rho * directionalAlbedo + rhoMultiScatter * ( 1.0 - directionalAlbedo );
	}
#endif
float V_GGX_SmithCorrelated( const in float alpha, const in float dotNL, const in float dotNV ) {
	float a2 = pow2( alpha );
	float gv = dotNL * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNV ) );
	float gl = dotNV * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNL ) );
	return 0.5 / max( gv + gl, EPSILON );
}
float D_GGX( const in float alpha, const in float dotNH ) {
	float a2 = pow2( alpha );
	float denom = pow2( dotNH ) * ( a2 - 1.0 ) + 1.0;
	return RECIPROCAL_PI * a2 / pow2( denom );
}
#ifdef USE_ANISOTROPY
	float V_GGX_SmithCorrelated_Anisotropic( const in float alphaT, const in float alphaB, const in float dotTV, const in float dotBV, const in float dotTL, const in float dotBL, const in float dotNV, const in float dotNL ) {
		float gv = dotNL * length( vec3( alphaT * dotTV, alphaB * dotBV, dotNV ) );
		float gl = dotNV * length( vec3( alphaT * dotTL, alphaB * dotBL, dotNL ) );
		return 0.5 / max( gv + gl, EPSILON );
	}
	float D_GGX_Anisotropic( const in float alphaT, const in float alphaB, const in float dotNH, const in float dotTH, const in float dotBH ) {
		float a2 = alphaT * alphaB;
		highp vec3 v = vec3( alphaB * dotTH, alphaT * dotBH, a2 * dotNH );
		highp float v2 = dot( v, v );
		float w2 = a2 / v2;
		return RECIPROCAL_PI * a2 * pow2 ( w2 );
	}
#endif
#ifdef USE_CLEARCOAT
	vec3 BRDF_GGX_Clearcoat( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material) {
		vec3 f0 = material.clearcoatF0;
		float f90 = material.clearcoatF90;
		float roughness = max( material.clearcoatRoughness, 0.045 );
		float alpha = pow2( roughness );
		vec3 halfDir = normalize( lightDir + viewDir );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float dotNH = saturate( dot( normal, halfDir ) );
		float dotVH = saturate( dot( viewDir, halfDir ) );
		vec3 F = F_Schlick( f0, f90, dotVH );
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
		return F * ( V * D );
	}
#endif
vec3 BRDF_GGX( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material ) {
	vec3 f0 = material.specularColorBlended;
	float f90 = material.specularF90;
	float roughness = max( material.roughness, 0.045 );
	float alpha = pow2( roughness );
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( f0, f90, dotVH );
	#ifdef USE_IRIDESCENCE
		F = mix( F, material.iridescenceFresnel, material.iridescence );
	#endif
	#ifdef USE_ANISOTROPY
		float dotTL = dot( material.anisotropyT, lightDir );
		float dotTV = dot( material.anisotropyT, viewDir );
		float dotTH = dot( material.anisotropyT, halfDir );
		float dotBL = dot( material.anisotropyB, lightDir );
		float dotBV = dot( material.anisotropyB, viewDir );
		float dotBH = dot( material.anisotropyB, halfDir );
		float alphaT = max( material.alphaT, alpha );
		float V = V_GGX_SmithCorrelated_Anisotropic( alphaT, alpha, dotTV, dotBV, dotTL, dotBL, dotNV, dotNL );
		float D = D_GGX_Anisotropic( alphaT, alpha, dotNH, dotTH, dotBH );
	#else
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
	#endif
	return F * ( V * D );
}
vec2 LTC_Uv( const in vec3 N, const in vec3 V, const in float roughness ) {
	const float LUT_SIZE = 64.0;
	const float LUT_SCALE = ( LUT_SIZE - 1.0 ) / LUT_SIZE;
	const float LUT_BIAS = 0.5 / LUT_SIZE;
	float dotNV = saturate( dot( N, V ) );
	vec2 uv = vec2( roughness, sqrt( 1.0 - dotNV ) );
	uv = uv * LUT_SCALE + LUT_BIAS;
	return uv;
}
float LTC_ClippedSphereFormFactor( const in vec3 f ) {
	float l = length( f );
	return max( ( l * l + f.z ) / ( l + 1.0 ), 0.0 );
}
vec3 LTC_EdgeVectorFormFactor( const in vec3 v1, const in vec3 v2 ) {
	float x = dot( v1, v2 );
	float y = abs( x );
	float a = 0.8543985 + ( 0.4965155 + 0.0145206 * y ) * y;
	float b = 3.4175940 + ( 4.1616724 + y ) * y;
	float v = a / b;
	float theta_sintheta = ( x > 0.0 ) ? v : 0.5 * inversesqrt( max( 1.0 - x * x, 1e-7 ) ) - v;
	return cross( v1, v2 ) * theta_sintheta;
}
vec3 LTC_Evaluate( const in vec3 N, const in vec3 V, const in vec3 P, const in mat3 mInv, const in vec3 rectCoords[ 4 ] ) {
	vec3 v1 = rectCoords[ 1 ] - rectCoords[ 0 ];
	vec3 v2 = rectCoords[ 3 ] - rectCoords[ 0 ];
	vec3 lightNormal = cross( v1, v2 );
	if( dot( lightNormal, P - rectCoords[ 0 ] ) < 0.0 ) return vec3( 0.0 );
	vec3 T1, T2;
	T1 = normalize( V - N * dot( V, N ) );
	T2 = - cross( N, T1 );
	mat3 mat = mInv * transpose( mat3( T1, T2, N ) );
	vec3 coords[ 4 ];
	coords[ 0 ] = mat * ( rectCoords[ 0 ] - P );
	coords[ 1 ] = mat * ( rectCoords[ 1 ] - P );
	coords[ 2 ] = mat * ( rectCoords[ 2 ] - P );
	coords[ 3 ] = mat * ( rectCoords[ 3 ] - P );
	coords[ 0 ] = normalize( coords[ 0 ] );
	coords[ 1 ] = normalize( coords[ 1 ] );
	coords[ 2 ] = normalize( coords[ 2 ] );
	coords[ 3 ] = normalize( coords[ 3 ] );
	vec3 vectorFormFactor = vec3( 0.0 );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 0 ], coords[ 1 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 1 ], coords[ 2 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 2 ], coords[ 3 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 3 ], coords[ 0 ] );
	float result = LTC_ClippedSphereFormFactor( vectorFormFactor );
	return vec3( result );
}
#if defined( USE_SHEEN )
float D_Charlie( float roughness, float dotNH ) {
	float alpha = pow2( roughness );
	float invAlpha = 1.0 / alpha;
	float cos2h = dotNH * dotNH;
	float sin2h = max( 1.0 - cos2h, 0.0078125 );
	return ( 2.0 + invAlpha ) * pow( sin2h, invAlpha * 0.5 ) / ( 2.0 * PI );
}
float V_Neubelt( float dotNV, float dotNL ) {
	return saturate( 1.0 / ( 4.0 * ( dotNL + dotNV - dotNL * dotNV ) ) );
}
vec3 BRDF_Sheen( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, vec3 sheenColor, const in float sheenRoughness ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float D = D_Charlie( sheenRoughness, dotNH );
	float V = V_Neubelt( dotNV, dotNL );
	return sheenColor * ( D * V );
}
#endif
float IBLSheenBRDF( const in vec3 normal, const in vec3 viewDir, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	float r2 = roughness * roughness;
	float rInv = 1.0 / ( roughness + 0.1 );
	float a = -1.9362 + 1.0678 * roughness + 0.4573 * r2 - 0.8469 * rInv;
	float b = -0.6014 + 0.5538 * roughness - 0.4670 * r2 - 0.1255 * rInv;
	float DG = exp( a * dotNV + b );
	return saturate( DG );
}
vec3 EnvironmentBRDF( const in vec3 normal, const in vec3 viewDir, const in vec3 specularColor, const in float specularF90, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	vec2 fab = texture2D( dfgLUT, vec2( roughness, dotNV ) ).rg;
	return specularColor * fab.x + specularF90 * fab.y;
}
#ifdef USE_IRIDESCENCE
void computeMultiscatteringIridescence( const in vec2 fab, const in vec3 specularColor, const in float specularF90, const in float iridescence, const in vec3 iridescenceF0, inout vec3 singleScatter, inout vec3 multiScatter ) {
#else
void computeMultiscattering( const in vec2 fab, const in vec3 specularColor, const in float specularF90, inout vec3 singleScatter, inout vec3 multiScatter ) {
#endif
	#ifdef USE_IRIDESCENCE
		vec3 Fr = mix( specularColor, iridescenceF0, iridescence );
	#else
		vec3 Fr = specularColor;
	#endif
	vec3 FssEss = Fr * fab.x + specularF90 * fab.y;
	float Ess = fab.x + fab.y;
	float Ems = 1.0 - Ess;
	vec3 Favg = Fr + ( 1.0 - Fr ) * 0.047619;	vec3 Fms = FssEss * Favg / ( 1.0 - Ems * Favg );
	singleScatter += FssEss;
	multiScatter += Fms * Ems;
}
#if NUM_RECT_AREA_LIGHTS > 0
	void RE_Direct_RectArea_Physical( const in RectAreaLight rectAreaLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
		vec3 normal = geometryNormal;
		vec3 viewDir = geometryViewDir;
		vec3 position = geometryPosition;
		vec3 lightPos = rectAreaLight.position;
		vec3 halfWidth = rectAreaLight.halfWidth;
		vec3 halfHeight = rectAreaLight.halfHeight;
		vec3 lightColor = rectAreaLight.color;
		float roughness = material.roughness;
		vec3 rectCoords[ 4 ];
		rectCoords[ 0 ] = lightPos + halfWidth - halfHeight;		rectCoords[ 1 ] = lightPos - halfWidth - halfHeight;
		rectCoords[ 2 ] = lightPos - halfWidth + halfHeight;
		rectCoords[ 3 ] = lightPos + halfWidth + halfHeight;
		vec2 uv = LTC_Uv( normal, viewDir, roughness );
		vec4 t1 = texture2D( ltc_1, uv );
		vec4 t2 = texture2D( ltc_2, uv );
		mat3 mInv = mat3(
			vec3( t1.x, 0, t1.y ),
			vec3(    0, 1,    0 ),
			vec3( t1.z, 0, t1.w )
		);
		vec3 fresnel = ( material.specularColorBlended * t2.x + ( material.specularF90 - material.specularColorBlended ) * t2.y );
		reflectedLight.directSpecular += lightColor * fresnel * LTC_Evaluate( normal, viewDir, position, mInv, rectCoords );
		reflectedLight.directDiffuse += lightColor * material.diffuseContribution * LTC_Evaluate( normal, viewDir, position, mat3( 1.0 ), rectCoords );
		#ifdef USE_CLEARCOAT
			vec3 Ncc = geometryClearcoatNormal;
			vec2 uvClearcoat = LTC_Uv( Ncc, viewDir, material.clearcoatRoughness );
			vec4 t1Clearcoat = texture2D( ltc_1, uvClearcoat );
			vec4 t2Clearcoat = texture2D( ltc_2, uvClearcoat );
			mat3 mInvClearcoat = mat3(
				vec3( t1Clearcoat.x, 0, t1Clearcoat.y ),
				vec3(             0, 1,             0 ),
				vec3( t1Clearcoat.z, 0, t1Clearcoat.w )
			);
			vec3 fresnelClearcoat = material.clearcoatF0 * t2Clearcoat.x + ( material.clearcoatF90 - material.clearcoatF0 ) * t2Clearcoat.y;
			clearcoatSpecularDirect += lightColor * fresnelClearcoat * LTC_Evaluate( Ncc, viewDir, position, mInvClearcoat, rectCoords );
		#endif
	}
#endif
void RE_Direct_Physical( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	#ifdef USE_CLEARCOAT
		float dotNLcc = saturate( dot( geometryClearcoatNormal, directLight.direction ) );
		vec3 ccIrradiance = dotNLcc * directLight.color;
		clearcoatSpecularDirect += ccIrradiance * BRDF_GGX_Clearcoat( directLight.direction, geometryViewDir, geometryClearcoatNormal, material );
	#endif
	#ifdef USE_SHEEN
 
 		sheenSpecularDirect += irradiance * BRDF_Sheen( directLight.direction, geometryViewDir, geometryNormal, material.sheenColor, material.sheenRoughness );
 
 		float sheenAlbedoV = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
 		float sheenAlbedoL = IBLSheenBRDF( geometryNormal, directLight.direction, material.sheenRoughness );
 
 		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * max( sheenAlbedoV, sheenAlbedoL );
 
 		irradiance *= sheenEnergyComp;
 
 	#endif
	vec3 specularBRDF = BRDF_GGX( directLight.direction, geometryViewDir, geometryNormal, material );
	#ifdef USE_RETROREFLECTION
		vec3 retroViewDir = reflect( - geometryViewDir, geometryNormal );
		vec3 retroSpecularBRDF = BRDF_GGX( directLight.direction, retroViewDir, geometryNormal, material );
		specularBRDF = mix( specularBRDF, retroSpecularBRDF, saturate( material.retroreflectivity ) );
	#endif
	reflectedLight.directSpecular += irradiance * specularBRDF * material.multiScatteringCompensation;
	vec3 halfDir = normalize( directLight.direction + geometryViewDir );
	float dotVH = saturate( dot( geometryViewDir, halfDir ) );
	vec3 F = F_Schlick( material.specularColor, material.specularF90, dotVH );
	#ifdef USE_RETROREFLECTION
		vec3 retroHalfDir = normalize( directLight.direction + retroViewDir );
		float dotRetroVH = saturate( dot( retroViewDir, retroHalfDir ) );
		vec3 retroF = F_Schlick( material.specularColor, material.specularF90, dotRetroVH );
		F = mix( F, retroF, saturate( material.retroreflectivity ) );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		vec3 diffuseBRDF = BRDF_EON( directLight.direction, geometryViewDir, geometryNormal, material.diffuseColor, material.diffuseRoughness ) * ( 1.0 - material.metalness );
	#else
		vec3 diffuseBRDF = BRDF_Lambert( material.diffuseContribution );
	#endif
	reflectedLight.directDiffuse += irradiance * diffuseBRDF * ( 1.0 - F );
}
void RE_IndirectDiffuse_Physical( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 singleScattering = vec3( 0.0 );
	vec3 multiScattering = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScattering, multiScattering );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScattering, multiScattering );
	#endif
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuseAlbedo = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness );
		vec3 diffuse = irradiance * RECIPROCAL_PI * diffuseAlbedo * ( 1.0 - singleScattering - multiScattering );
	#else
		vec3 diffuse = irradiance * BRDF_Lambert( material.diffuseContribution ) * ( 1.0 - singleScattering - multiScattering );
	#endif
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		sheenSpecularIndirect += irradiance * material.sheenColor * sheenAlbedo * RECIPROCAL_PI;
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		diffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectDiffuse += diffuse;
}
void RE_IndirectSpecular_Physical( const in vec3 radiance, const in vec3 irradiance, const in vec3 clearcoatRadiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight) {
	#ifdef USE_CLEARCOAT
		clearcoatSpecularIndirect += clearcoatRadiance * EnvironmentBRDF( geometryClearcoatNormal, geometryViewDir, material.clearcoatF0, material.clearcoatF90, material.clearcoatRoughness );
	#endif
	#ifdef USE_SHEEN
		sheenSpecularIndirect += irradiance * material.sheenColor * IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness ) * RECIPROCAL_PI;
 	#endif
	vec3 singleScatteringDielectric = vec3( 0.0 );
	vec3 multiScatteringDielectric = vec3( 0.0 );
	vec3 singleScatteringMetallic = vec3( 0.0 );
	vec3 multiScatteringMetallic = vec3( 0.0 );
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( material.dfg, material.specularColor, material.specularF90, material.iridescence, material.iridescenceF0Dielectric, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscatteringIridescence( material.dfg, material.diffuseColor, material.specularF90, material.iridescence, material.iridescenceF0Metallic, singleScatteringMetallic, multiScatteringMetallic );
	#else
		computeMultiscattering( material.dfg, material.specularColor, material.specularF90, singleScatteringDielectric, multiScatteringDielectric );
		computeMultiscattering( material.dfg, material.diffuseColor, material.specularF90, singleScatteringMetallic, multiScatteringMetallic );
	#endif
	vec3 singleScattering = mix( singleScatteringDielectric, singleScatteringMetallic, material.metalness );
	vec3 multiScattering = mix( multiScatteringDielectric, multiScatteringMetallic, material.metalness );
	vec3 totalScatteringDielectric = singleScatteringDielectric + multiScatteringDielectric;
	#ifdef USE_DIFFUSE_ROUGHNESS
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		vec3 diffuse = EON_DirectionalAlbedo( material.diffuseColor, material.diffuseRoughness, dotNV ) * ( 1.0 - material.metalness ) * ( 1.0 - totalScatteringDielectric );
	#else
		vec3 diffuse = material.diffuseContribution * ( 1.0 - totalScatteringDielectric );
	#endif
	vec3 cosineWeightedIrradiance = irradiance * RECIPROCAL_PI;
	vec3 indirectSpecular = radiance * singleScattering;
	indirectSpecular += multiScattering * cosineWeightedIrradiance;
	vec3 indirectDiffuse = diffuse * cosineWeightedIrradiance;
	#ifdef USE_SHEEN
		float sheenAlbedo = IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
		float sheenEnergyComp = 1.0 - max3( material.sheenColor ) * sheenAlbedo;
		indirectSpecular *= sheenEnergyComp;
		indirectDiffuse *= sheenEnergyComp;
	#endif
	reflectedLight.indirectSpecular += indirectSpecular;
	reflectedLight.indirectDiffuse += indirectDiffuse;
}
#define RE_Direct				RE_Direct_Physical
#define RE_Direct_RectArea		RE_Direct_RectArea_Physical
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Physical
#define RE_IndirectSpecular		RE_IndirectSpecular_Physical
float computeSpecularOcclusion( const in float dotNV, const in float ambientOcclusion, const in float roughness ) {
	return saturate( pow( dotNV + ambientOcclusion, exp2( - 16.0 * roughness - 1.0 ) ) - 1.0 + ambientOcclusion );
}`,lights_fragment_begin:`
vec3 geometryPosition = - vViewPosition;
vec3 geometryNormal = normal;
vec3 geometryViewDir = ( isOrthographic ) ? vec3( 0, 0, 1 ) : normalize( vViewPosition );
vec3 geometryClearcoatNormal = vec3( 0.0 );
#ifdef USE_CLEARCOAT
	geometryClearcoatNormal = clearcoatNormal;
#endif
#ifdef USE_IRIDESCENCE
	float dotNVi = saturate( dot( normal, geometryViewDir ) );
	if ( material.iridescenceThickness == 0.0 ) {
		material.iridescence = 0.0;
	} else {
		material.iridescence = saturate( material.iridescence );
	}
	if ( material.iridescence > 0.0 ) {
		vec3 iridescenceFresnelDielectric = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.specularColor );
		vec3 iridescenceFresnelMetallic = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.diffuseColor );
		material.iridescenceFresnel = mix( iridescenceFresnelDielectric, iridescenceFresnelMetallic, material.metalness );
		material.iridescenceF0Dielectric = Schlick_to_F0( iridescenceFresnelDielectric, 1.0, dotNVi );
		material.iridescenceF0Metallic = Schlick_to_F0( iridescenceFresnelMetallic, 1.0, dotNVi );
	}
#endif
#ifdef STANDARD
	float dotNVms = saturate( dot( geometryNormal, geometryViewDir ) );
	material.dfg = texture2D( dfgLUT, vec2( material.roughness, dotNVms ) ).rg;
	#if ( NUM_SUN_LIGHTS > 0 || NUM_DIR_LIGHTS > 0 || NUM_POINT_LIGHTS > 0 || NUM_SPOT_LIGHTS > 0 )
		float EssMs = material.dfg.x + material.dfg.y;
		material.multiScatteringCompensation = 1.0 + material.specularColorBlended * ( 1.0 / EssMs - 1.0 );
	#endif
#endif
IncidentLight directLight;
#if ( NUM_POINT_LIGHTS > 0 ) && defined( RE_Direct )
	PointLight pointLight;
	#if defined( USE_SHADOWMAP ) && NUM_POINT_LIGHT_SHADOWS > 0
	PointLightShadow pointLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHTS; i ++ ) {
		pointLight = pointLights[ i ];
		getPointLightInfo( pointLight, geometryPosition, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_POINT_LIGHT_SHADOWS ) && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
		pointLightShadow = pointLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getPointShadow( pointShadowMap[ i ], pointLightShadow.shadowMapSize, pointLightShadow.shadowIntensity, pointLightShadow.shadowBias, pointLightShadow.shadowRadius, vPointShadowCoord[ i ], pointLightShadow.shadowCameraNear, pointLightShadow.shadowCameraFar ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SPOT_LIGHTS > 0 ) && defined( RE_Direct )
	SpotLight spotLight;
	vec4 spotColor;
	vec3 spotLightCoord;
	bool inSpotLightMap;
	#if defined( USE_SHADOWMAP ) && NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHTS; i ++ ) {
		spotLight = spotLights[ i ];
		getSpotLightInfo( spotLight, geometryPosition, directLight );
		#if ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#define SPOT_LIGHT_MAP_INDEX UNROLLED_LOOP_INDEX
		#elif ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		#define SPOT_LIGHT_MAP_INDEX NUM_SPOT_LIGHT_MAPS
		#else
		#define SPOT_LIGHT_MAP_INDEX ( UNROLLED_LOOP_INDEX - NUM_SPOT_LIGHT_SHADOWS + NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#endif
		#if ( SPOT_LIGHT_MAP_INDEX < NUM_SPOT_LIGHT_MAPS )
			spotLightCoord = vSpotLightCoord[ i ].xyz / vSpotLightCoord[ i ].w;
			inSpotLightMap = all( lessThan( abs( spotLightCoord * 2. - 1. ), vec3( 1.0 ) ) );
			spotColor = texture2D( spotLightMap[ SPOT_LIGHT_MAP_INDEX ], spotLightCoord.xy );
			directLight.color = inSpotLightMap ? directLight.color * spotColor.rgb : directLight.color;
		#endif
		#undef SPOT_LIGHT_MAP_INDEX
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		spotLightShadow = spotLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( spotShadowMap[ i ], spotLightShadow.shadowMapSize, spotLightShadow.shadowIntensity, spotLightShadow.shadowBias, spotLightShadow.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SUN_LIGHTS > 0 ) && defined( RE_Direct )
	SunLight sunLight;
	#if defined( USE_SHADOWMAP ) && NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHTS; i ++ ) {
		sunLight = sunLights[ i ];
		getSunLightInfo( sunLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SUN_LIGHT_SHADOWS )
		sunLightShadow = sunLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getSunShadow( sunShadowMap[ i ], sunLightShadow, UNROLLED_LOOP_INDEX ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_DIR_LIGHTS > 0 ) && defined( RE_Direct )
	DirectionalLight directionalLight;
	#if defined( USE_SHADOWMAP ) && NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHTS; i ++ ) {
		directionalLight = directionalLights[ i ];
		getDirectionalLightInfo( directionalLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_DIR_LIGHT_SHADOWS )
		directionalLightShadow = directionalLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( directionalShadowMap[ i ], directionalLightShadow.shadowMapSize, directionalLightShadow.shadowIntensity, directionalLightShadow.shadowBias, directionalLightShadow.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_RECT_AREA_LIGHTS > 0 ) && defined( RE_Direct_RectArea )
	RectAreaLight rectAreaLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_RECT_AREA_LIGHTS; i ++ ) {
		rectAreaLight = rectAreaLights[ i ];
		RE_Direct_RectArea( rectAreaLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if defined( RE_IndirectDiffuse )
	vec3 iblIrradiance = vec3( 0.0 );
	vec3 irradiance = getAmbientLightIrradiance( ambientLightColor );
	#if defined( USE_LIGHT_PROBES )
		irradiance += getLightProbeIrradiance( lightProbe, geometryNormal );
	#endif
	#if ( NUM_HEMI_LIGHTS > 0 )
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_HEMI_LIGHTS; i ++ ) {
			irradiance += getHemisphereLightIrradiance( hemisphereLights[ i ], geometryNormal );
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_LIGHT_PROBE_GRIDS > 0
		vec3 probeWorldPos = ( ( vec4( geometryPosition, 1.0 ) - viewMatrix[ 3 ] ) * viewMatrix ).xyz;
		vec3 probeWorldNormal = transformNormalByInverseViewMatrix( geometryNormal, viewMatrix );
		int probeGrid = - 1;
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( isInsideLightProbeGrid( probeWorldPos, probeWorldNormal, probesMin[ i ], probesMax[ i ], probesResolution[ i ] ) ) probeGrid = UNROLLED_LOOP_INDEX;
		}
		#pragma unroll_loop_end
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_LIGHT_PROBE_GRIDS; i ++ ) {
			if ( probeGrid == UNROLLED_LOOP_INDEX ) irradiance += getLightProbeGridIrradiance( probesSH[ i ], probesMin[ i ], probesMax[ i ], probesResolution[ i ], probeWorldPos, probeWorldNormal );
		}
		#pragma unroll_loop_end
	#endif
#endif
#if defined( RE_IndirectSpecular )
	vec3 radiance = vec3( 0.0 );
	vec3 clearcoatRadiance = vec3( 0.0 );
#endif`,lights_fragment_maps:`#if defined( RE_IndirectDiffuse )
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		vec3 lightMapIrradiance = lightMapTexel.rgb * lightMapIntensity;
		irradiance += lightMapIrradiance;
	#endif
	#if defined( USE_ENVMAP ) && defined( ENVMAP_TYPE_PMREM )
		#if defined( STANDARD ) || defined( LAMBERT ) || defined( PHONG )
			iblIrradiance += getIBLIrradiance( geometryNormal );
		#endif
	#endif
#endif
#if defined( USE_ENVMAP ) && defined( RE_IndirectSpecular )
	#ifdef USE_ANISOTROPY
		vec3 iblRadiance = getIBLAnisotropyRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
	#else
		vec3 iblRadiance = getIBLRadiance( geometryViewDir, geometryNormal, material.roughness );
	#endif
	#ifdef USE_RETROREFLECTION
		#ifdef USE_ANISOTROPY
			vec3 retroIBLRadiance = getIBLAnisotropyRetroRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
		#else
			vec3 retroIBLRadiance = getIBLRetroRadiance( geometryViewDir, geometryNormal, material.roughness );
		#endif
		iblRadiance = mix( iblRadiance, retroIBLRadiance, saturate( material.retroreflectivity ) );
	#endif
	radiance += iblRadiance;
	#ifdef USE_CLEARCOAT
		clearcoatRadiance += getIBLRadiance( geometryViewDir, geometryClearcoatNormal, material.clearcoatRoughness );
	#endif
#endif`,lights_fragment_end:`#if defined( RE_IndirectDiffuse )
	#if defined( LAMBERT ) || defined( PHONG )
		irradiance += iblIrradiance;
	#endif
	RE_IndirectDiffuse( irradiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif
#if defined( RE_IndirectSpecular )
	RE_IndirectSpecular( radiance, iblIrradiance, clearcoatRadiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif`,lightprobes_pars_fragment:`#if NUM_LIGHT_PROBE_GRIDS > 0
uniform highp sampler3D probesSH[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMin[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesMax[ NUM_LIGHT_PROBE_GRIDS ];
uniform vec3 probesResolution[ NUM_LIGHT_PROBE_GRIDS ];
bool isInsideLightProbeGrid( vec3 worldPos, vec3 worldNormal, vec3 probesMin, vec3 probesMax, vec3 probesResolution ) {
	vec3 spacing = ( probesMax - probesMin ) / probesResolution;
	vec3 samplePos = worldPos + worldNormal * spacing * 0.5;
	vec3 margin = spacing * 0.01;
	return all( greaterThanEqual( samplePos, probesMin - margin ) ) && all( lessThanEqual( samplePos, probesMax + margin ) );
}
vec3 getLightProbeGridIrradiance( highp sampler3D probesSH, vec3 probesMin, vec3 probesMax, vec3 probesResolution, vec3 worldPos, vec3 worldNormal ) {
	vec3 res = probesResolution;
	vec3 gridRange = probesMax - probesMin;
	vec3 probeSpacing = gridRange / res;
	vec3 samplePos = worldPos + worldNormal * probeSpacing * 0.5;
	vec3 uvw = clamp( ( samplePos - probesMin ) / gridRange, 0.5 / res, 1.0 - 0.5 / res );
	float nz          = res.z;
	float paddedSlices = nz + 2.0;
	float atlasDepth  = 7.0 * paddedSlices;
	float uvZBase     = uvw.z * nz + 1.0;
	vec4 s0 = texture( probesSH, vec3( uvw.xy, ( uvZBase                       ) / atlasDepth ) );
	vec4 s1 = texture( probesSH, vec3( uvw.xy, ( uvZBase +       paddedSlices   ) / atlasDepth ) );
	vec4 s2 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 2.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s3 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 3.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s4 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 4.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s5 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 5.0 * paddedSlices   ) / atlasDepth ) );
	vec4 s6 = texture( probesSH, vec3( uvw.xy, ( uvZBase + 6.0 * paddedSlices   ) / atlasDepth ) );
	vec3 c0 = s0.xyz;
	vec3 c1 = vec3( s0.w, s1.xy );
	vec3 c2 = vec3( s1.zw, s2.x );
	vec3 c3 = s2.yzw;
	vec3 c4 = s3.xyz;
	vec3 c5 = vec3( s3.w, s4.xy );
	vec3 c6 = vec3( s4.zw, s5.x );
	vec3 c7 = s5.yzw;
	vec3 c8 = s6.xyz;
	float x = worldNormal.x, y = worldNormal.y, z = worldNormal.z;
	vec3 result = c0 * 0.886227;
	result += c1 * 2.0 * 0.511664 * y;
	result += c2 * 2.0 * 0.511664 * z;
	result += c3 * 2.0 * 0.511664 * x;
	result += c4 * 2.0 * 0.429043 * x * y;
	result += c5 * 2.0 * 0.429043 * y * z;
	result += c6 * ( 0.743125 * z * z - 0.247708 );
	result += c7 * 2.0 * 0.429043 * x * z;
	result += c8 * 0.429043 * ( x * x - y * y );
	return max( result, vec3( 0.0 ) );
}
#endif`,logdepthbuf_fragment:`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	gl_FragDepth = vIsPerspective == 0.0 ? gl_FragCoord.z : log2( vFragDepth ) * logDepthBufFC * 0.5;
#endif`,logdepthbuf_pars_fragment:`#if defined( USE_LOGARITHMIC_DEPTH_BUFFER )
	uniform float logDepthBufFC;
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,logdepthbuf_pars_vertex:`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,logdepthbuf_vertex:`#ifdef USE_LOGARITHMIC_DEPTH_BUFFER
	vFragDepth = 1.0 + gl_Position.w;
	vIsPerspective = float( isPerspectiveMatrix( projectionMatrix ) );
#endif`,map_fragment:`#ifdef USE_MAP
	vec4 sampledDiffuseColor = texture2D( map, vMapUv );
	#ifdef DECODE_VIDEO_TEXTURE
		sampledDiffuseColor = sRGBTransferEOTF( sampledDiffuseColor );
	#endif
	diffuseColor *= sampledDiffuseColor;
#endif`,map_pars_fragment:`#ifdef USE_MAP
	uniform sampler2D map;
#endif`,map_particle_fragment:`#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
	#if defined( USE_POINTS_UV )
		vec2 uv = vUv;
	#else
		vec2 uv = ( uvTransform * vec3( gl_PointCoord.x, 1.0 - gl_PointCoord.y, 1 ) ).xy;
	#endif
#endif
#ifdef USE_MAP
	diffuseColor *= texture2D( map, uv );
#endif
#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, uv ).g;
#endif`,map_particle_pars_fragment:`#if defined( USE_POINTS_UV )
	varying vec2 vUv;
#else
	#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
		uniform mat3 uvTransform;
	#endif
#endif
#ifdef USE_MAP
	uniform sampler2D map;
#endif
#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,metalnessmap_fragment:`float metalnessFactor = metalness;
#ifdef USE_METALNESSMAP
	vec4 texelMetalness = texture2D( metalnessMap, vMetalnessMapUv );
	metalnessFactor *= texelMetalness.b;
#endif`,metalnessmap_pars_fragment:`#ifdef USE_METALNESSMAP
	uniform sampler2D metalnessMap;
#endif`,morphinstance_vertex:`#ifdef USE_INSTANCING_MORPH
	float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	float morphTargetBaseInfluence = texelFetch( morphTexture, ivec2( 0, gl_InstanceID ), 0 ).r;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		morphTargetInfluences[i] =  texelFetch( morphTexture, ivec2( i + 1, gl_InstanceID ), 0 ).r;
	}
#endif`,morphcolor_vertex:`#if defined( USE_MORPHCOLORS )
	#if defined( USE_COLOR_ALPHA )
		vColor *= morphTargetBaseInfluence;
	#elif defined( USE_COLOR )
		vColor.rgb *= morphTargetBaseInfluence;
	#endif
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		#if defined( USE_COLOR_ALPHA )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor += getMorph( gl_VertexID, i, 2 ) * morphTargetInfluences[ i ];
		#elif defined( USE_COLOR )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor.rgb += getMorph( gl_VertexID, i, 2 ).rgb * morphTargetInfluences[ i ];
		#endif
	}
#endif`,morphnormal_vertex:`#ifdef USE_MORPHNORMALS
	objectNormal *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) objectNormal += getMorph( gl_VertexID, i, 1 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,morphtarget_pars_vertex:`#ifdef USE_MORPHTARGETS
	#ifndef USE_INSTANCING_MORPH
		uniform float morphTargetBaseInfluence;
		uniform float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	#endif
	uniform sampler2DArray morphTargetsTexture;
	uniform ivec2 morphTargetsTextureSize;
	vec4 getMorph( const in int vertexIndex, const in int morphTargetIndex, const in int offset ) {
		int texelIndex = vertexIndex * MORPHTARGETS_TEXTURE_STRIDE + offset;
		int y = texelIndex / morphTargetsTextureSize.x;
		int x = texelIndex - y * morphTargetsTextureSize.x;
		ivec3 morphUV = ivec3( x, y, morphTargetIndex );
		return texelFetch( morphTargetsTexture, morphUV, 0 );
	}
#endif`,morphtarget_vertex:`#ifdef USE_MORPHTARGETS
	transformed *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) transformed += getMorph( gl_VertexID, i, 0 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,normal_fragment_begin:`float faceDirection = gl_FrontFacing ? 1.0 : - 1.0;
#ifdef FLAT_SHADED
	vec3 fdx = dFdx( vViewPosition );
	vec3 fdy = dFdy( vViewPosition );
	vec3 normal = normalize( cross( fdx, fdy ) );
#else
	vec3 normal = normalize( vNormal );
	#ifdef DOUBLE_SIDED
		normal *= faceDirection;
	#endif
#endif
#if defined( USE_NORMALMAP_TANGENTSPACE ) || defined( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY )
	#ifdef USE_TANGENT
		mat3 tbn = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn = getTangentFrame( - vViewPosition, normal,
		#if defined( USE_NORMALMAP )
			vNormalMapUv
		#elif defined( USE_CLEARCOAT_NORMALMAP )
			vClearcoatNormalMapUv
		#else
			vUv
		#endif
		);
	#endif
	#ifdef DOUBLE_SIDED
		tbn[0] *= faceDirection;
		tbn[1] *= faceDirection;
	#endif
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	#ifdef USE_TANGENT
		mat3 tbn2 = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn2 = getTangentFrame( - vViewPosition, normal, vClearcoatNormalMapUv );
	#endif
	#ifdef DOUBLE_SIDED
		tbn2[0] *= faceDirection;
		tbn2[1] *= faceDirection;
	#endif
#endif
vec3 nonPerturbedNormal = normal;`,normal_fragment_maps:`#ifdef USE_NORMALMAP_OBJECTSPACE
	normal = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#ifdef FLIP_SIDED
		normal = - normal;
	#endif
	#ifdef DOUBLE_SIDED
		normal = normal * faceDirection;
	#endif
	normal = normalize( normalMatrix * normal );
#elif defined( USE_NORMALMAP_TANGENTSPACE )
	vec3 mapN = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#if defined( USE_PACKED_NORMALMAP )
		mapN = vec3( mapN.xy, sqrt( saturate( 1.0 - dot( mapN.xy, mapN.xy ) ) ) );
	#endif
	mapN.xy *= normalScale;
	normal = normalize( tbn * mapN );
#elif defined( USE_BUMPMAP )
	normal = perturbNormalArb( - vViewPosition, normal, dHdxy_fwd(), faceDirection );
#endif`,normal_pars_fragment:`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,normal_pars_vertex:`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,normal_vertex:`#ifndef FLAT_SHADED
	vNormal = normalize( transformedNormal );
	#ifdef USE_TANGENT
		vTangent = normalize( transformedTangent );
		vBitangent = normalize( cross( vNormal, vTangent ) * tangent.w );
		#ifdef FLIP_SIDED
			vBitangent = - vBitangent;
		#endif
	#endif
#endif`,normalmap_pars_fragment:`#ifdef USE_NORMALMAP
	uniform sampler2D normalMap;
	uniform vec2 normalScale;
#endif
#ifdef USE_NORMALMAP_OBJECTSPACE
	uniform mat3 normalMatrix;
#endif
#if ! defined ( USE_TANGENT ) && ( defined ( USE_NORMALMAP_TANGENTSPACE ) || defined ( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY ) )
	mat3 getTangentFrame( vec3 eye_pos, vec3 surf_norm, vec2 uv ) {
		vec3 q0 = dFdx( eye_pos.xyz );
		vec3 q1 = dFdy( eye_pos.xyz );
		vec2 st0 = dFdx( uv.st );
		vec2 st1 = dFdy( uv.st );
		vec3 N = surf_norm;
		vec3 q1perp = cross( q1, N );
		vec3 q0perp = cross( N, q0 );
		vec3 T = q1perp * st0.x + q0perp * st1.x;
		vec3 B = q1perp * st0.y + q0perp * st1.y;
		float det = max( dot( T, T ), dot( B, B ) );
		float scale = ( det == 0.0 ) ? 0.0 : inversesqrt( det );
		return mat3( T * scale, B * scale, N );
	}
#endif`,clearcoat_normal_fragment_begin:`#ifdef USE_CLEARCOAT
	vec3 clearcoatNormal = nonPerturbedNormal;
#endif`,clearcoat_normal_fragment_maps:`#ifdef USE_CLEARCOAT_NORMALMAP
	vec3 clearcoatMapN = texture2D( clearcoatNormalMap, vClearcoatNormalMapUv ).xyz * 2.0 - 1.0;
	clearcoatMapN.xy *= clearcoatNormalScale;
	clearcoatNormal = normalize( tbn2 * clearcoatMapN );
#endif`,clearcoat_pars_fragment:`#ifdef USE_CLEARCOATMAP
	uniform sampler2D clearcoatMap;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform sampler2D clearcoatNormalMap;
	uniform vec2 clearcoatNormalScale;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform sampler2D clearcoatRoughnessMap;
#endif`,iridescence_pars_fragment:`#ifdef USE_IRIDESCENCEMAP
	uniform sampler2D iridescenceMap;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform sampler2D iridescenceThicknessMap;
#endif`,opaque_fragment:`#ifdef OPAQUE
diffuseColor.a = 1.0;
#endif
#ifdef USE_TRANSMISSION
diffuseColor.a *= material.transmissionAlpha;
#endif
gl_FragColor = vec4( outgoingLight, diffuseColor.a );`,packing:`vec3 packNormalToRGB( const in vec3 normal ) {
	return normalize( normal ) * 0.5 + 0.5;
}
vec3 unpackRGBToNormal( const in vec3 rgb ) {
	return 2.0 * rgb.xyz - 1.0;
}
const float PackUpscale = 256. / 255.;const float UnpackDownscale = 255. / 256.;const float ShiftRight8 = 1. / 256.;
const float Inv255 = 1. / 255.;
const vec4 PackFactors = vec4( 1.0, 256.0, 256.0 * 256.0, 256.0 * 256.0 * 256.0 );
const vec2 UnpackFactors2 = vec2( UnpackDownscale, 1.0 / PackFactors.g );
const vec3 UnpackFactors3 = vec3( UnpackDownscale / PackFactors.rg, 1.0 / PackFactors.b );
const vec4 UnpackFactors4 = vec4( UnpackDownscale / PackFactors.rgb, 1.0 / PackFactors.a );
vec4 packDepthToRGBA( const in float v ) {
	if( v <= 0.0 )
		return vec4( 0., 0., 0., 0. );
	if( v >= 1.0 )
		return vec4( 1., 1., 1., 1. );
	float vuf;
	float af = modf( v * PackFactors.a, vuf );
	float bf = modf( vuf * ShiftRight8, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec4( vuf * Inv255, gf * PackUpscale, bf * PackUpscale, af );
}
vec3 packDepthToRGB( const in float v ) {
	if( v <= 0.0 )
		return vec3( 0., 0., 0. );
	if( v >= 1.0 )
		return vec3( 1., 1., 1. );
	float vuf;
	float bf = modf( v * PackFactors.b, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec3( vuf * Inv255, gf * PackUpscale, bf );
}
vec2 packDepthToRG( const in float v ) {
	if( v <= 0.0 )
		return vec2( 0., 0. );
	if( v >= 1.0 )
		return vec2( 1., 1. );
	float vuf;
	float gf = modf( v * 256., vuf );
	return vec2( vuf * Inv255, gf );
}
float unpackRGBAToDepth( const in vec4 v ) {
	return dot( v, UnpackFactors4 );
}
float unpackRGBToDepth( const in vec3 v ) {
	return dot( v, UnpackFactors3 );
}
float unpackRGToDepth( const in vec2 v ) {
	return v.r * UnpackFactors2.r + v.g * UnpackFactors2.g;
}
vec4 pack2HalfToRGBA( const in vec2 v ) {
	vec4 r = vec4( v.x, fract( v.x * 255.0 ), v.y, fract( v.y * 255.0 ) );
	return vec4( r.x - r.y / 255.0, r.y, r.z - r.w / 255.0, r.w );
}
vec2 unpackRGBATo2Half( const in vec4 v ) {
	return vec2( v.x + ( v.y / 255.0 ), v.z + ( v.w / 255.0 ) );
}
float viewZToOrthographicDepth( const in float viewZ, const in float near, const in float far ) {
	return ( viewZ + near ) / ( near - far );
}
float orthographicDepthToViewZ( const in float depth, const in float near, const in float far ) {
	#ifdef USE_REVERSED_DEPTH_BUFFER
	
		return depth * ( far - near ) - far;
	#else
		return depth * ( near - far ) - near;
	#endif
}
float viewZToPerspectiveDepth( const in float viewZ, const in float near, const in float far ) {
	return ( ( near + viewZ ) * far ) / ( ( far - near ) * viewZ );
}
float perspectiveDepthToViewZ( const in float depth, const in float near, const in float far ) {
	
	#ifdef USE_REVERSED_DEPTH_BUFFER
		return ( near * far ) / ( ( near - far ) * depth - near );
	#else
		return ( near * far ) / ( ( far - near ) * depth - far );
	#endif
}`,premultiplied_alpha_fragment:`#ifdef PREMULTIPLIED_ALPHA
	gl_FragColor.rgb *= gl_FragColor.a;
#endif`,project_vertex:`vec4 mvPosition = vec4( transformed, 1.0 );
#ifdef USE_BATCHING
	mvPosition = batchingMatrix * mvPosition;
#endif
#ifdef USE_INSTANCING
	mvPosition = instanceMatrix * mvPosition;
#endif
mvPosition = modelViewMatrix * mvPosition;
gl_Position = projectionMatrix * mvPosition;`,dithering_fragment:`#ifdef DITHERING
	gl_FragColor.rgb = dithering( gl_FragColor.rgb );
#endif`,dithering_pars_fragment:`#ifdef DITHERING
	vec3 dithering( vec3 color ) {
		float grid_position = rand( gl_FragCoord.xy );
		vec3 dither_shift_RGB = vec3( 0.25 / 255.0, -0.25 / 255.0, 0.25 / 255.0 );
		dither_shift_RGB = mix( 2.0 * dither_shift_RGB, -2.0 * dither_shift_RGB, grid_position );
		return color + dither_shift_RGB;
	}
#endif`,roughnessmap_fragment:`float roughnessFactor = roughness;
#ifdef USE_ROUGHNESSMAP
	vec4 texelRoughness = texture2D( roughnessMap, vRoughnessMapUv );
	roughnessFactor *= texelRoughness.g;
#endif`,roughnessmap_pars_fragment:`#ifdef USE_ROUGHNESSMAP
	uniform sampler2D roughnessMap;
#endif`,shadowmap_pars_fragment:`#if NUM_SPOT_LIGHT_COORDS > 0
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#if NUM_SPOT_LIGHT_MAPS > 0
	uniform sampler2D spotLightMap[ NUM_SPOT_LIGHT_MAPS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		#define SUN_LIGHT_CASCADES 2
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#else
			uniform sampler2D sunShadowMap[ NUM_SUN_LIGHT_SHADOWS ];
		#endif
		uniform mat4 sunShadowMatrix[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		uniform vec4 sunShadowCascade[ NUM_SUN_LIGHT_SHADOWS * SUN_LIGHT_CASCADES ];
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
		struct SunLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SunLightShadow sunLightShadows[ NUM_SUN_LIGHT_SHADOWS ];
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#else
			uniform sampler2D directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		#endif
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform sampler2DShadow spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#else
			uniform sampler2D spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		#endif
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#if defined( SHADOWMAP_TYPE_PCF )
			uniform samplerCubeShadow pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#elif defined( SHADOWMAP_TYPE_BASIC )
			uniform samplerCube pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		#endif
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float interleavedGradientNoise( vec2 position ) {
			return fract( 52.9829189 * fract( dot( position, vec2( 0.06711056, 0.00583715 ) ) ) );
		}
		vec2 vogelDiskSample( int sampleIndex, int samplesCount, float phi ) {
			const float goldenAngle = 2.399963229728653;
			float r = sqrt( ( float( sampleIndex ) + 0.5 ) / float( samplesCount ) );
			float theta = float( sampleIndex ) * goldenAngle + phi;
			return vec2( cos( theta ), sin( theta ) ) * r;
		}
	#endif
	#if defined( SHADOWMAP_TYPE_PCF )
		float getShadow( sampler2DShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 texelSize = vec2( 1.0 ) / shadowMapSize;
				vec2 radius = shadowRadius * texelSize;
				float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
				shadow = (
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 0, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 1, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 2, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 3, 5, phi ) * radius, shadowCoord.z ) ) +
					texture( shadowMap, vec3( shadowCoord.xy + vogelDiskSample( 4, 5, phi ) * radius, shadowCoord.z ) )
				) * 0.2;
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#elif defined( SHADOWMAP_TYPE_VSM )
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				vec2 distribution = texture2D( shadowMap, shadowCoord.xy ).rg;
				float mean = distribution.x;
				float variance = distribution.y * distribution.y;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					float hard_shadow = step( mean, shadowCoord.z );
				#else
					float hard_shadow = step( shadowCoord.z, mean );
				#endif
				
				if ( hard_shadow == 1.0 ) {
					shadow = 1.0;
				} else {
					variance = max( variance, 0.0000001 );
					float d = shadowCoord.z - mean;
					float p_max = variance / ( variance + d * d );
					p_max = clamp( ( p_max - 0.3 ) / 0.65, 0.0, 1.0 );
					shadow = max( hard_shadow, p_max );
				}
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#else
		float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
			float shadow = 1.0;
			shadowCoord.xyz /= shadowCoord.w;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				shadowCoord.z -= shadowBias;
			#else
				shadowCoord.z += shadowBias;
			#endif
			bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
			bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
			if ( frustumTest ) {
				float depth = texture2D( shadowMap, shadowCoord.xy ).r;
				#ifdef USE_REVERSED_DEPTH_BUFFER
					shadow = step( depth, shadowCoord.z );
				#else
					shadow = step( shadowCoord.z, depth );
				#endif
			}
			return mix( 1.0, shadow, shadowIntensity );
		}
	#endif
	#if NUM_SUN_LIGHT_SHADOWS > 0
		float getSunShadow(
			#if defined( SHADOWMAP_TYPE_PCF )
				sampler2DShadow shadowMap,
			#else
				sampler2D shadowMap,
			#endif
			SunLightShadow sunLightShadow,
			int shadowIndex
		) {
			vec4 shadowWorldPosition = vec4( vSunShadowWorldPosition.xyz + vSunShadowWorldNormal * sunLightShadow.shadowNormalBias, 1.0 );
			float viewDepth = vSunShadowWorldPosition.w;
			int cascadeOffset = shadowIndex * SUN_LIGHT_CASCADES;
			float shadow = 1.0;
			for ( int i = SUN_LIGHT_CASCADES - 1; i >= 0; i -- ) {
				vec4 cascade = sunShadowCascade[ cascadeOffset + i ];
				if ( viewDepth >= cascade.x && viewDepth < cascade.y ) {
					float cascadeShadow = getShadow(
						shadowMap,
						sunLightShadow.shadowMapSize,
						sunLightShadow.shadowIntensity,
						sunLightShadow.shadowBias,
						sunLightShadow.shadowRadius,
						sunShadowMatrix[ cascadeOffset + i ] * shadowWorldPosition
					);
					shadow = mix( cascadeShadow, shadow, smoothstep( cascade.z, cascade.y, viewDepth ) );
				}
			}
			return shadow;
		}
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
	#if defined( SHADOWMAP_TYPE_PCF )
	float getPointShadow( samplerCubeShadow shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 bd3D = normalize( lightToPosition );
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float lightDistance = length( lightToPosition );
			float depthRange = shadowCameraFar - shadowCameraNear;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				float depthA = - shadowCameraNear / depthRange - shadowBias;
				float depthB = shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#else
				float depthA = shadowCameraFar / depthRange + shadowBias;
				float depthB = - shadowCameraNear * shadowCameraFar / ( depthRange * lightDistance );
			#endif
			float texelSize = shadowRadius / shadowMapSize.x;
			vec3 absDir = abs( bd3D );
			vec3 tangent = absDir.x > absDir.z ? vec3( 0.0, 1.0, 0.0 ) : vec3( 1.0, 0.0, 0.0 );
			tangent = normalize( cross( bd3D, tangent ) );
			vec3 bitangent = cross( bd3D, tangent );
			float phi = interleavedGradientNoise( gl_FragCoord.xy ) * PI2;
			shadow = 0.0;
			for ( int i = 0; i < 5; i ++ ) {
				vec2 offset = vogelDiskSample( i, 5, phi );
				vec3 direction = bd3D + ( tangent * offset.x + bitangent * offset.y ) * texelSize;
				vec3 absDirection = abs( direction );
				float dp = depthA + depthB / max( max( absDirection.x, absDirection.y ), absDirection.z );
				shadow += texture( shadowMap, vec4( direction, dp ) );
			}
			shadow *= 0.2;
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#elif defined( SHADOWMAP_TYPE_BASIC )
	float getPointShadow( samplerCube shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		vec3 absVec = abs( lightToPosition );
		float viewSpaceZ = max( max( absVec.x, absVec.y ), absVec.z );
		if ( viewSpaceZ - shadowCameraFar <= 0.0 && viewSpaceZ - shadowCameraNear >= 0.0 ) {
			float dp = ( shadowCameraFar * ( viewSpaceZ - shadowCameraNear ) ) / ( viewSpaceZ * ( shadowCameraFar - shadowCameraNear ) );
			dp += shadowBias;
			vec3 bd3D = normalize( lightToPosition );
			float depth = textureCube( shadowMap, bd3D ).r;
			#ifdef USE_REVERSED_DEPTH_BUFFER
				depth = 1.0 - depth;
			#endif
			shadow = step( dp, depth );
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	#endif
	#endif
#endif`,shadowmap_pars_vertex:`#if NUM_SPOT_LIGHT_COORDS > 0
	uniform mat4 spotLightMatrix[ NUM_SPOT_LIGHT_COORDS ];
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
		varying vec4 vSunShadowWorldPosition;
		varying vec3 vSunShadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		uniform mat4 directionalShadowMatrix[ NUM_DIR_LIGHT_SHADOWS ];
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		uniform mat4 pointShadowMatrix[ NUM_POINT_LIGHT_SHADOWS ];
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
#endif`,shadowmap_vertex:`#if ( defined( USE_SHADOWMAP ) && ( NUM_DIR_LIGHT_SHADOWS > 0 || NUM_SUN_LIGHT_SHADOWS > 0 || NUM_POINT_LIGHT_SHADOWS > 0 ) ) || ( NUM_SPOT_LIGHT_COORDS > 0 )
	#ifdef HAS_NORMAL
		vec3 shadowWorldNormal = transformNormalByInverseViewMatrix( transformedNormal, viewMatrix );
	#else
		vec3 shadowWorldNormal = vec3( 0.0 );
	#endif
	vec4 shadowWorldPosition;
#endif
#if defined( USE_SHADOWMAP )
	#if NUM_SUN_LIGHT_SHADOWS > 0
		vSunShadowWorldPosition = vec4( worldPosition.xyz, - mvPosition.z );
		vSunShadowWorldNormal = shadowWorldNormal;
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * directionalLightShadows[ i ].shadowNormalBias, 0 );
			vDirectionalShadowCoord[ i ] = directionalShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * pointLightShadows[ i ].shadowNormalBias, 0 );
			vPointShadowCoord[ i ] = pointShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
#endif
#if NUM_SPOT_LIGHT_COORDS > 0
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_COORDS; i ++ ) {
		shadowWorldPosition = worldPosition;
		#if ( defined( USE_SHADOWMAP ) && UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
			shadowWorldPosition.xyz += shadowWorldNormal * spotLightShadows[ i ].shadowNormalBias;
		#endif
		vSpotLightCoord[ i ] = spotLightMatrix[ i ] * shadowWorldPosition;
	}
	#pragma unroll_loop_end
#endif`,shadowmask_pars_fragment:`float getShadowMask() {
	float shadow = 1.0;
	#ifdef USE_SHADOWMAP
	#if NUM_SUN_LIGHT_SHADOWS > 0
	SunLightShadow sunLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SUN_LIGHT_SHADOWS; i ++ ) {
		sunLight = sunLightShadows[ i ];
		shadow *= receiveShadow ? getSunShadow( sunShadowMap[ i ], sunLight, UNROLLED_LOOP_INDEX ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
		directionalLight = directionalLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( directionalShadowMap[ i ], directionalLight.shadowMapSize, directionalLight.shadowIntensity, directionalLight.shadowBias, directionalLight.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_SHADOWS; i ++ ) {
		spotLight = spotLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( spotShadowMap[ i ], spotLight.shadowMapSize, spotLight.shadowIntensity, spotLight.shadowBias, spotLight.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0 && ( defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_BASIC ) )
	PointLightShadow pointLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
		pointLight = pointLightShadows[ i ];
		shadow *= receiveShadow ? getPointShadow( pointShadowMap[ i ], pointLight.shadowMapSize, pointLight.shadowIntensity, pointLight.shadowBias, pointLight.shadowRadius, vPointShadowCoord[ i ], pointLight.shadowCameraNear, pointLight.shadowCameraFar ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#endif
	return shadow;
}`,skinbase_vertex:`#ifdef USE_SKINNING
	mat4 boneMatX = getBoneMatrix( skinIndex.x );
	mat4 boneMatY = getBoneMatrix( skinIndex.y );
	mat4 boneMatZ = getBoneMatrix( skinIndex.z );
	mat4 boneMatW = getBoneMatrix( skinIndex.w );
#endif`,skinning_pars_vertex:`#ifdef USE_SKINNING
	uniform mat4 bindMatrix;
	uniform mat4 bindMatrixInverse;
	uniform highp sampler2D boneTexture;
	mat4 getBoneMatrix( const in float i ) {
		int size = textureSize( boneTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( boneTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( boneTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( boneTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( boneTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
#endif`,skinning_vertex:`#ifdef USE_SKINNING
	vec4 skinVertex = bindMatrix * vec4( transformed, 1.0 );
	vec4 skinned = vec4( 0.0 );
	skinned += boneMatX * skinVertex * skinWeight.x;
	skinned += boneMatY * skinVertex * skinWeight.y;
	skinned += boneMatZ * skinVertex * skinWeight.z;
	skinned += boneMatW * skinVertex * skinWeight.w;
	transformed = ( bindMatrixInverse * skinned ).xyz;
#endif`,skinnormal_vertex:`#ifdef USE_SKINNING
	mat4 skinMatrix = mat4( 0.0 );
	skinMatrix += skinWeight.x * boneMatX;
	skinMatrix += skinWeight.y * boneMatY;
	skinMatrix += skinWeight.z * boneMatZ;
	skinMatrix += skinWeight.w * boneMatW;
	skinMatrix = bindMatrixInverse * skinMatrix * bindMatrix;
	objectNormal = vec4( skinMatrix * vec4( objectNormal, 0.0 ) ).xyz;
	#ifdef USE_TANGENT
		objectTangent = vec4( skinMatrix * vec4( objectTangent, 0.0 ) ).xyz;
	#endif
#endif`,specularmap_fragment:`float specularStrength;
#ifdef USE_SPECULARMAP
	vec4 texelSpecular = texture2D( specularMap, vSpecularMapUv );
	specularStrength = texelSpecular.r;
#else
	specularStrength = 1.0;
#endif`,specularmap_pars_fragment:`#ifdef USE_SPECULARMAP
	uniform sampler2D specularMap;
#endif`,tonemapping_fragment:`#if defined( TONE_MAPPING )
	gl_FragColor.rgb = toneMapping( gl_FragColor.rgb );
#endif`,tonemapping_pars_fragment:`#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
uniform float toneMappingExposure;
vec3 LinearToneMapping( vec3 color ) {
	return saturate( toneMappingExposure * color );
}
vec3 ReinhardToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	return saturate( color / ( vec3( 1.0 ) + color ) );
}
vec3 CineonToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	color = max( vec3( 0.0 ), color - 0.004 );
	return pow( ( color * ( 6.2 * color + 0.5 ) ) / ( color * ( 6.2 * color + 1.7 ) + 0.06 ), vec3( 2.2 ) );
}
vec3 RRTAndODTFit( vec3 v ) {
	vec3 a = v * ( v + 0.0245786 ) - 0.000090537;
	vec3 b = v * ( 0.983729 * v + 0.4329510 ) + 0.238081;
	return a / b;
}
vec3 ACESFilmicToneMapping( vec3 color ) {
	const mat3 ACESInputMat = mat3(
		vec3( 0.59719, 0.07600, 0.02840 ),		vec3( 0.35458, 0.90834, 0.13383 ),
		vec3( 0.04823, 0.01566, 0.83777 )
	);
	const mat3 ACESOutputMat = mat3(
		vec3(  1.60475, -0.10208, -0.00327 ),		vec3( -0.53108,  1.10813, -0.07276 ),
		vec3( -0.07367, -0.00605,  1.07602 )
	);
	color *= toneMappingExposure / 0.6;
	color = ACESInputMat * color;
	color = RRTAndODTFit( color );
	color = ACESOutputMat * color;
	return saturate( color );
}
const mat3 LINEAR_REC2020_TO_LINEAR_SRGB = mat3(
	vec3( 1.6605, - 0.1246, - 0.0182 ),
	vec3( - 0.5876, 1.1329, - 0.1006 ),
	vec3( - 0.0728, - 0.0083, 1.1187 )
);
const mat3 LINEAR_SRGB_TO_LINEAR_REC2020 = mat3(
	vec3( 0.6274, 0.0691, 0.0164 ),
	vec3( 0.3293, 0.9195, 0.0880 ),
	vec3( 0.0433, 0.0113, 0.8956 )
);
vec3 agxDefaultContrastApprox( vec3 x ) {
	vec3 x2 = x * x;
	vec3 x4 = x2 * x2;
	return + 15.5 * x4 * x2
		- 40.14 * x4 * x
		+ 31.96 * x4
		- 6.868 * x2 * x
		+ 0.4298 * x2
		+ 0.1191 * x
		- 0.00232;
}
vec3 AgXToneMapping( vec3 color ) {
	const mat3 AgXInsetMatrix = mat3(
		vec3( 0.856627153315983, 0.137318972929847, 0.11189821299995 ),
		vec3( 0.0951212405381588, 0.761241990602591, 0.0767994186031903 ),
		vec3( 0.0482516061458583, 0.101439036467562, 0.811302368396859 )
	);
	const mat3 AgXOutsetMatrix = mat3(
		vec3( 1.1271005818144368, - 0.1413297634984383, - 0.14132976349843826 ),
		vec3( - 0.11060664309660323, 1.157823702216272, - 0.11060664309660294 ),
		vec3( - 0.016493938717834573, - 0.016493938717834257, 1.2519364065950405 )
	);
	const float AgxMinEv = - 12.47393;	const float AgxMaxEv = 4.026069;
	color *= toneMappingExposure;
	color = LINEAR_SRGB_TO_LINEAR_REC2020 * color;
	color = AgXInsetMatrix * color;
	color = max( color, 1e-10 );	color = log2( color );
	color = ( color - AgxMinEv ) / ( AgxMaxEv - AgxMinEv );
	color = clamp( color, 0.0, 1.0 );
	color = agxDefaultContrastApprox( color );
	color = AgXOutsetMatrix * color;
	color = pow( max( vec3( 0.0 ), color ), vec3( 2.2 ) );
	color = LINEAR_REC2020_TO_LINEAR_SRGB * color;
	color = clamp( color, 0.0, 1.0 );
	return color;
}
vec3 NeutralToneMapping( vec3 color ) {
	const float StartCompression = 0.8 - 0.04;
	const float Desaturation = 0.15;
	color *= toneMappingExposure;
	float x = min( color.r, min( color.g, color.b ) );
	float offset = x < 0.08 ? x - 6.25 * x * x : 0.04;
	color -= offset;
	float peak = max( color.r, max( color.g, color.b ) );
	if ( peak < StartCompression ) return color;
	float d = 1. - StartCompression;
	float newPeak = 1. - d * d / ( peak + d - StartCompression );
	color *= newPeak / peak;
	float g = 1. - 1. / ( Desaturation * ( peak - newPeak ) + 1. );
	return mix( color, vec3( newPeak ), g );
}
vec3 CustomToneMapping( vec3 color ) { return color; }`,transmission_fragment:`#ifdef USE_TRANSMISSION
	material.transmission = transmission;
	material.transmissionAlpha = 1.0;
	material.thickness = thickness;
	material.attenuationDistance = attenuationDistance;
	material.attenuationColor = attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		material.transmission *= texture2D( transmissionMap, vTransmissionMapUv ).r;
	#endif
	#ifdef USE_THICKNESSMAP
		material.thickness *= texture2D( thicknessMap, vThicknessMapUv ).g;
	#endif
	vec3 pos = vWorldPosition;
	vec3 v = normalize( cameraPosition - pos );
	vec3 n = transformNormalByInverseViewMatrix( normal, viewMatrix );
	vec4 transmitted = getIBLVolumeRefraction(
		n, v, material.roughness, material.diffuseContribution, material.specularColorBlended, material.specularF90,
		pos, modelMatrix, viewMatrix, projectionMatrix, material.dispersion, material.ior, material.thickness,
		material.attenuationColor, material.attenuationDistance );
	material.transmissionAlpha = mix( material.transmissionAlpha, transmitted.a, material.transmission );
	totalDiffuse = mix( totalDiffuse, transmitted.rgb, material.transmission );
#endif`,transmission_pars_fragment:`#ifdef USE_TRANSMISSION
	uniform float transmission;
	uniform float thickness;
	uniform float attenuationDistance;
	uniform vec3 attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		uniform sampler2D transmissionMap;
	#endif
	#ifdef USE_THICKNESSMAP
		uniform sampler2D thicknessMap;
	#endif
	uniform vec2 transmissionSamplerSize;
	uniform sampler2D transmissionSamplerMap;
	uniform mat4 modelMatrix;
	uniform mat4 projectionMatrix;
	varying vec3 vWorldPosition;
	float w0( float a ) {
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - a + 3.0 ) - 3.0 ) + 1.0 );
	}
	float w1( float a ) {
		return ( 1.0 / 6.0 ) * ( a *  a * ( 3.0 * a - 6.0 ) + 4.0 );
	}
	float w2( float a ){
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - 3.0 * a + 3.0 ) + 3.0 ) + 1.0 );
	}
	float w3( float a ) {
		return ( 1.0 / 6.0 ) * ( a * a * a );
	}
	float g0( float a ) {
		return w0( a ) + w1( a );
	}
	float g1( float a ) {
		return w2( a ) + w3( a );
	}
	float h0( float a ) {
		return - 1.0 + w1( a ) / ( w0( a ) + w1( a ) );
	}
	float h1( float a ) {
		return 1.0 + w3( a ) / ( w2( a ) + w3( a ) );
	}
	vec4 bicubic( sampler2D tex, vec2 uv, vec4 texelSize, float lod ) {
		uv = uv * texelSize.zw + 0.5;
		vec2 iuv = floor( uv );
		vec2 fuv = fract( uv );
		float g0x = g0( fuv.x );
		float g1x = g1( fuv.x );
		float h0x = h0( fuv.x );
		float h1x = h1( fuv.x );
		float h0y = h0( fuv.y );
		float h1y = h1( fuv.y );
		vec2 p0 = ( vec2( iuv.x + h0x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p1 = ( vec2( iuv.x + h1x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p2 = ( vec2( iuv.x + h0x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		vec2 p3 = ( vec2( iuv.x + h1x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		return g0( fuv.y ) * ( g0x * textureLod( tex, p0, lod ) + g1x * textureLod( tex, p1, lod ) ) +
			g1( fuv.y ) * ( g0x * textureLod( tex, p2, lod ) + g1x * textureLod( tex, p3, lod ) );
	}
	vec4 textureBicubic( sampler2D sampler, vec2 uv, float lod ) {
		vec2 fLodSize = vec2( textureSize( sampler, int( lod ) ) );
		vec2 cLodSize = vec2( textureSize( sampler, int( lod + 1.0 ) ) );
		vec2 fLodSizeInv = 1.0 / fLodSize;
		vec2 cLodSizeInv = 1.0 / cLodSize;
		vec4 fSample = bicubic( sampler, uv, vec4( fLodSizeInv, fLodSize ), floor( lod ) );
		vec4 cSample = bicubic( sampler, uv, vec4( cLodSizeInv, cLodSize ), ceil( lod ) );
		return mix( fSample, cSample, fract( lod ) );
	}
	vec3 getVolumeTransmissionRay( const in vec3 n, const in vec3 v, const in float thickness, const in float ior, const in mat4 modelMatrix ) {
		vec3 refractionVector = refract( - v, normalize( n ), 1.0 / ior );
		vec3 modelScale;
		modelScale.x = length( vec3( modelMatrix[ 0 ].xyz ) );
		modelScale.y = length( vec3( modelMatrix[ 1 ].xyz ) );
		modelScale.z = length( vec3( modelMatrix[ 2 ].xyz ) );
		return normalize( refractionVector ) * thickness * modelScale;
	}
	float applyIorToRoughness( const in float roughness, const in float ior ) {
		return roughness * clamp( ior * 2.0 - 2.0, 0.0, 1.0 );
	}
	vec4 getTransmissionSample( const in vec2 fragCoord, const in float roughness, const in float ior ) {
		float lod = log2( transmissionSamplerSize.x ) * applyIorToRoughness( roughness, ior );
		return textureBicubic( transmissionSamplerMap, fragCoord.xy, lod );
	}
	vec3 volumeAttenuation( const in float transmissionDistance, const in vec3 attenuationColor, const in float attenuationDistance ) {
		if ( isinf( attenuationDistance ) ) {
			return vec3( 1.0 );
		} else {
			vec3 attenuationCoefficient = -log( attenuationColor ) / attenuationDistance;
			vec3 transmittance = exp( - attenuationCoefficient * transmissionDistance );			return transmittance;
		}
	}
	vec4 getIBLVolumeRefraction( const in vec3 n, const in vec3 v, const in float roughness, const in vec3 diffuseColor,
		const in vec3 specularColor, const in float specularF90, const in vec3 position, const in mat4 modelMatrix,
		const in mat4 viewMatrix, const in mat4 projMatrix, const in float dispersion, const in float ior, const in float thickness,
		const in vec3 attenuationColor, const in float attenuationDistance ) {
		vec4 transmittedLight;
		vec3 transmittance;
		#ifdef USE_DISPERSION
			float halfSpread = ( ior - 1.0 ) * 0.025 * dispersion;
			vec3 iors = vec3( ior - halfSpread, ior, ior + halfSpread );
			for ( int i = 0; i < 3; i ++ ) {
				vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, iors[ i ], modelMatrix );
				vec3 refractedRayExit = position + transmissionRay;
				vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
				vec2 refractionCoords = ndcPos.xy / ndcPos.w;
				refractionCoords += 1.0;
				refractionCoords /= 2.0;
				vec4 transmissionSample = getTransmissionSample( refractionCoords, roughness, iors[ i ] );
				transmittedLight[ i ] = transmissionSample[ i ];
				transmittedLight.a += transmissionSample.a;
				transmittance[ i ] = diffuseColor[ i ] * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance )[ i ];
			}
			transmittedLight.a /= 3.0;
		#else
			vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, ior, modelMatrix );
			vec3 refractedRayExit = position + transmissionRay;
			vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
			vec2 refractionCoords = ndcPos.xy / ndcPos.w;
			refractionCoords += 1.0;
			refractionCoords /= 2.0;
			transmittedLight = getTransmissionSample( refractionCoords, roughness, ior );
			transmittance = diffuseColor * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance );
		#endif
		vec3 attenuatedColor = transmittance * transmittedLight.rgb;
		vec3 F = EnvironmentBRDF( n, v, specularColor, specularF90, roughness );
		float transmittanceFactor = ( transmittance.r + transmittance.g + transmittance.b ) / 3.0;
		return vec4( ( 1.0 - F ) * attenuatedColor, 1.0 - ( 1.0 - transmittedLight.a ) * transmittanceFactor );
	}
#endif`,uv_pars_fragment:`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_SPECULARMAP
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,uv_pars_vertex:`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	uniform mat3 mapTransform;
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	uniform mat3 alphaMapTransform;
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	uniform mat3 lightMapTransform;
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	uniform mat3 aoMapTransform;
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	uniform mat3 bumpMapTransform;
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	uniform mat3 normalMapTransform;
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_DISPLACEMENTMAP
	uniform mat3 displacementMapTransform;
	varying vec2 vDisplacementMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	uniform mat3 emissiveMapTransform;
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	uniform mat3 metalnessMapTransform;
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	uniform mat3 roughnessMapTransform;
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	uniform mat3 diffuseRoughnessMapTransform;
	varying vec2 vDiffuseRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	uniform mat3 anisotropyMapTransform;
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	uniform mat3 clearcoatMapTransform;
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform mat3 clearcoatNormalMapTransform;
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform mat3 clearcoatRoughnessMapTransform;
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	uniform mat3 sheenColorMapTransform;
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	uniform mat3 sheenRoughnessMapTransform;
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	uniform mat3 iridescenceMapTransform;
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform mat3 iridescenceThicknessMapTransform;
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SPECULARMAP
	uniform mat3 specularMapTransform;
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	uniform mat3 specularColorMapTransform;
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	uniform mat3 specularIntensityMapTransform;
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,uv_vertex:`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	vUv = vec3( uv, 1 ).xy;
#endif
#ifdef USE_MAP
	vMapUv = ( mapTransform * vec3( MAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ALPHAMAP
	vAlphaMapUv = ( alphaMapTransform * vec3( ALPHAMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_LIGHTMAP
	vLightMapUv = ( lightMapTransform * vec3( LIGHTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_AOMAP
	vAoMapUv = ( aoMapTransform * vec3( AOMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_BUMPMAP
	vBumpMapUv = ( bumpMapTransform * vec3( BUMPMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_NORMALMAP
	vNormalMapUv = ( normalMapTransform * vec3( NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DISPLACEMENTMAP
	vDisplacementMapUv = ( displacementMapTransform * vec3( DISPLACEMENTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_EMISSIVEMAP
	vEmissiveMapUv = ( emissiveMapTransform * vec3( EMISSIVEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_METALNESSMAP
	vMetalnessMapUv = ( metalnessMapTransform * vec3( METALNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ROUGHNESSMAP
	vRoughnessMapUv = ( roughnessMapTransform * vec3( ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DIFFUSE_ROUGHNESSMAP
	vDiffuseRoughnessMapUv = ( diffuseRoughnessMapTransform * vec3( DIFFUSE_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ANISOTROPYMAP
	vAnisotropyMapUv = ( anisotropyMapTransform * vec3( ANISOTROPYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOATMAP
	vClearcoatMapUv = ( clearcoatMapTransform * vec3( CLEARCOATMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	vClearcoatNormalMapUv = ( clearcoatNormalMapTransform * vec3( CLEARCOAT_NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	vClearcoatRoughnessMapUv = ( clearcoatRoughnessMapTransform * vec3( CLEARCOAT_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCEMAP
	vIridescenceMapUv = ( iridescenceMapTransform * vec3( IRIDESCENCEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	vIridescenceThicknessMapUv = ( iridescenceThicknessMapTransform * vec3( IRIDESCENCE_THICKNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_COLORMAP
	vSheenColorMapUv = ( sheenColorMapTransform * vec3( SHEEN_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	vSheenRoughnessMapUv = ( sheenRoughnessMapTransform * vec3( SHEEN_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULARMAP
	vSpecularMapUv = ( specularMapTransform * vec3( SPECULARMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_COLORMAP
	vSpecularColorMapUv = ( specularColorMapTransform * vec3( SPECULAR_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	vSpecularIntensityMapUv = ( specularIntensityMapTransform * vec3( SPECULAR_INTENSITYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_TRANSMISSIONMAP
	vTransmissionMapUv = ( transmissionMapTransform * vec3( TRANSMISSIONMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_THICKNESSMAP
	vThicknessMapUv = ( thicknessMapTransform * vec3( THICKNESSMAP_UV, 1 ) ).xy;
#endif`,worldpos_vertex:`#if defined( USE_ENVMAP ) || defined( DISTANCE ) || defined ( USE_SHADOWMAP ) || defined ( USE_TRANSMISSION ) || NUM_SPOT_LIGHT_COORDS > 0
	vec4 worldPosition = vec4( transformed, 1.0 );
	#ifdef USE_BATCHING
		worldPosition = batchingMatrix * worldPosition;
	#endif
	#ifdef USE_INSTANCING
		worldPosition = instanceMatrix * worldPosition;
	#endif
	worldPosition = modelMatrix * worldPosition;
#endif`,background_vert:`varying vec2 vUv;
uniform mat3 uvTransform;
void main() {
	vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	gl_Position = vec4( position.xy, 1.0, 1.0 );
}`,background_frag:`uniform sampler2D t2D;
uniform float backgroundIntensity;
varying vec2 vUv;
void main() {
	vec4 texColor = texture2D( t2D, vUv );
	#ifdef DECODE_VIDEO_TEXTURE
		texColor = vec4( mix( pow( texColor.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), texColor.rgb * 0.0773993808, vec3( lessThanEqual( texColor.rgb, vec3( 0.04045 ) ) ) ), texColor.w );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,backgroundCube_vert:`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,backgroundCube_frag:`uniform float backgroundBlurriness;
uniform float backgroundIntensity;
uniform mat3 backgroundRotation;
varying vec3 vWorldDirection;
#include <envmap_common_pars_fragment>
void main() {
	#ifdef ENVMAP_TYPE_PMREM
		vec4 texColor = textureLod( envMap, backgroundRotation * vWorldDirection, roughnessToMip( backgroundBlurriness ) );
	#else
		vec4 texColor = textureCube( envMap, backgroundRotation * vWorldDirection );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,cube_vert:`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,cube_frag:`uniform samplerCube tCube;
uniform float tFlip;
uniform float opacity;
varying vec3 vWorldDirection;
void main() {
	vec4 texColor = textureCube( tCube, vec3( tFlip * vWorldDirection.x, vWorldDirection.yz ) );
	gl_FragColor = texColor;
	gl_FragColor.a *= opacity;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,depth_vert:`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
varying vec2 vHighPrecisionZW;
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vHighPrecisionZW = gl_Position.zw;
}`,depth_frag:`#if DEPTH_PACKING == 3200
	uniform float opacity;
#endif
#include <common>
#include <packing>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
varying vec2 vHighPrecisionZW;
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#if DEPTH_PACKING == 3200
		diffuseColor.a = opacity;
	#endif
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <logdepthbuf_fragment>
	#ifdef USE_REVERSED_DEPTH_BUFFER
		float fragCoordZ = vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ];
	#else
		float fragCoordZ = 0.5 * vHighPrecisionZW[ 0 ] / vHighPrecisionZW[ 1 ] + 0.5;
	#endif
	#if DEPTH_PACKING == 3200
		gl_FragColor = vec4( vec3( 1.0 - fragCoordZ ), opacity );
	#elif DEPTH_PACKING == 3201
		gl_FragColor = packDepthToRGBA( fragCoordZ );
	#elif DEPTH_PACKING == 3202
		gl_FragColor = vec4( packDepthToRGB( fragCoordZ ), 1.0 );
	#elif DEPTH_PACKING == 3203
		gl_FragColor = vec4( packDepthToRG( fragCoordZ ), 0.0, 1.0 );
	#endif
}`,distance_vert:`#define DISTANCE
varying vec3 vWorldPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <worldpos_vertex>
	#include <clipping_planes_vertex>
	vWorldPosition = worldPosition.xyz;
}`,distance_frag:`#define DISTANCE
uniform vec3 referencePosition;
uniform float nearDistance;
uniform float farDistance;
varying vec3 vWorldPosition;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	float dist = length( vWorldPosition - referencePosition );
	dist = ( dist - nearDistance ) / ( farDistance - nearDistance );
	dist = saturate( dist );
	gl_FragColor = vec4( dist, 0.0, 0.0, 1.0 );
}`,equirect_vert:`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
}`,equirect_frag:`uniform sampler2D tEquirect;
varying vec3 vWorldDirection;
#include <common>
void main() {
	vec3 direction = normalize( vWorldDirection );
	vec2 sampleUV = equirectUv( direction );
	gl_FragColor = texture2D( tEquirect, sampleUV );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,linedashed_vert:`uniform float scale;
attribute float lineDistance;
varying float vLineDistance;
#include <common>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	vLineDistance = scale * lineDistance;
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,linedashed_frag:`uniform vec3 diffuse;
uniform float opacity;
uniform float dashSize;
uniform float totalSize;
varying float vLineDistance;
#include <common>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	if ( mod( vLineDistance, totalSize ) > dashSize ) {
		discard;
	}
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,meshbasic_vert:`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#if defined ( USE_ENVMAP ) || defined ( USE_SKINNING )
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinbase_vertex>
		#include <skinnormal_vertex>
		#include <defaultnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <fog_vertex>
}`,meshbasic_frag:`uniform vec3 diffuse;
uniform float opacity;
#ifndef FLAT_SHADED
	varying vec3 vNormal;
#endif
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <fog_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		reflectedLight.indirectDiffuse += lightMapTexel.rgb * lightMapIntensity * RECIPROCAL_PI;
	#else
		reflectedLight.indirectDiffuse += vec3( 1.0 );
	#endif
	#include <aomap_fragment>
	reflectedLight.indirectDiffuse *= diffuseColor.rgb;
	vec3 outgoingLight = reflectedLight.indirectDiffuse;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,meshlambert_vert:`#define LAMBERT
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,meshlambert_frag:`#define LAMBERT
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_lambert_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_lambert_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,meshmatcap_vert:`#define MATCAP
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <displacementmap_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
	vViewPosition = - mvPosition.xyz;
}`,meshmatcap_frag:`#define MATCAP
uniform vec3 diffuse;
uniform float opacity;
uniform sampler2D matcap;
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	vec3 viewDir = normalize( vViewPosition );
	vec3 x = normalize( vec3( viewDir.z, 0.0, - viewDir.x ) );
	vec3 y = cross( viewDir, x );
	vec2 uv = vec2( dot( x, normal ), dot( y, normal ) ) * 0.495 + 0.5;
	#ifdef USE_MATCAP
		vec4 matcapColor = texture2D( matcap, uv );
	#else
		vec4 matcapColor = vec4( vec3( mix( 0.2, 0.8, uv.y ) ), 1.0 );
	#endif
	vec3 outgoingLight = diffuseColor.rgb * matcapColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,meshnormal_vert:`#define NORMAL
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	vViewPosition = - mvPosition.xyz;
#endif
}`,meshnormal_frag:`#define NORMAL
uniform float opacity;
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <uv_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 0.0, 0.0, 0.0, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	gl_FragColor = vec4( normalize( normal ) * 0.5 + 0.5, diffuseColor.a );
	#ifdef OPAQUE
		gl_FragColor.a = 1.0;
	#endif
}`,meshphong_vert:`#define PHONG
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,meshphong_frag:`#define PHONG
uniform vec3 diffuse;
uniform vec3 emissive;
uniform vec3 specular;
uniform float shininess;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_phong_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_phong_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + reflectedLight.directSpecular + reflectedLight.indirectSpecular + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,meshphysical_vert:`#define STANDARD
varying vec3 vViewPosition;
#ifdef USE_TRANSMISSION
	varying vec3 vWorldPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
#ifdef USE_TRANSMISSION
	vWorldPosition = worldPosition.xyz;
#endif
}`,meshphysical_frag:`#define STANDARD
#ifdef PHYSICAL
	#define IOR
	#define USE_SPECULAR
#endif
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float roughness;
uniform float metalness;
uniform float opacity;
#ifdef IOR
	uniform float ior;
#endif
#ifdef USE_SPECULAR
	uniform float specularIntensity;
	uniform vec3 specularColor;
	#ifdef USE_SPECULAR_COLORMAP
		uniform sampler2D specularColorMap;
	#endif
	#ifdef USE_SPECULAR_INTENSITYMAP
		uniform sampler2D specularIntensityMap;
	#endif
#endif
#ifdef USE_CLEARCOAT
	uniform float clearcoat;
	uniform float clearcoatRoughness;
#endif
#ifdef USE_DIFFUSE_ROUGHNESS
	uniform float diffuseRoughness;
	#ifdef USE_DIFFUSE_ROUGHNESSMAP
		uniform sampler2D diffuseRoughnessMap;
	#endif
#endif
#ifdef USE_DISPERSION
	uniform float dispersion;
#endif
#ifdef USE_RETROREFLECTION
	uniform float retroreflectivity;
#endif
#ifdef USE_IRIDESCENCE
	uniform float iridescence;
	uniform float iridescenceIOR;
	uniform float iridescenceThicknessMinimum;
	uniform float iridescenceThicknessMaximum;
#endif
#ifdef USE_SHEEN
	uniform vec3 sheenColor;
	uniform float sheenRoughness;
	#ifdef USE_SHEEN_COLORMAP
		uniform sampler2D sheenColorMap;
	#endif
	#ifdef USE_SHEEN_ROUGHNESSMAP
		uniform sampler2D sheenRoughnessMap;
	#endif
#endif
#ifdef USE_ANISOTROPY
	uniform vec2 anisotropyVector;
	#ifdef USE_ANISOTROPYMAP
		uniform sampler2D anisotropyMap;
	#endif
#endif
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <iridescence_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_physical_pars_fragment>
#include <transmission_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <clearcoat_pars_fragment>
#include <iridescence_pars_fragment>
#include <roughnessmap_pars_fragment>
#include <metalnessmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <roughnessmap_fragment>
	#include <metalnessmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <clearcoat_normal_fragment_begin>
	#include <clearcoat_normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_physical_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 totalDiffuse = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse;
	vec3 totalSpecular = reflectedLight.directSpecular + reflectedLight.indirectSpecular;
	#include <transmission_fragment>
	vec3 outgoingLight = totalDiffuse + totalSpecular + totalEmissiveRadiance;
	#ifdef USE_SHEEN
 
		outgoingLight = outgoingLight + sheenSpecularDirect + sheenSpecularIndirect;
 
 	#endif
	#ifdef USE_CLEARCOAT
		float dotNVcc = saturate( dot( geometryClearcoatNormal, geometryViewDir ) );
		vec3 Fcc = F_Schlick( material.clearcoatF0, material.clearcoatF90, dotNVcc );
		outgoingLight = outgoingLight * ( 1.0 - material.clearcoat * Fcc ) + ( clearcoatSpecularDirect + clearcoatSpecularIndirect ) * material.clearcoat;
	#endif
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,meshtoon_vert:`#define TOON
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,meshtoon_frag:`#define TOON
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <gradientmap_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_toon_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_toon_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,points_vert:`uniform float size;
uniform float scale;
#include <common>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
#ifdef USE_POINTS_UV
	varying vec2 vUv;
	uniform mat3 uvTransform;
#endif
void main() {
	#ifdef USE_POINTS_UV
		vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	#endif
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	gl_PointSize = size;
	#ifdef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) gl_PointSize *= ( scale / - mvPosition.z );
	#endif
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <fog_vertex>
}`,points_frag:`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <color_pars_fragment>
#include <map_particle_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_particle_fragment>
	#include <color_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,shadow_vert:`#include <common>
#include <batching_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <shadowmap_pars_vertex>
void main() {
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,shadow_frag:`uniform vec3 color;
uniform float opacity;
#include <common>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <logdepthbuf_pars_fragment>
#include <shadowmap_pars_fragment>
#include <shadowmask_pars_fragment>
void main() {
	#include <logdepthbuf_fragment>
	gl_FragColor = vec4( color, opacity * ( 1.0 - getShadowMask() ) );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,sprite_vert:`uniform float rotation;
uniform vec2 center;
#include <common>
#include <uv_pars_vertex>
#include <fog_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	vec4 mvPosition = modelViewMatrix[ 3 ];
	vec2 scale = vec2( length( modelMatrix[ 0 ].xyz ), length( modelMatrix[ 1 ].xyz ) );
	#ifndef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) scale *= - mvPosition.z;
	#endif
	vec2 alignedPosition = ( position.xy - ( center - vec2( 0.5 ) ) ) * scale;
	vec2 rotatedPosition;
	rotatedPosition.x = cos( rotation ) * alignedPosition.x - sin( rotation ) * alignedPosition.y;
	rotatedPosition.y = sin( rotation ) * alignedPosition.x + cos( rotation ) * alignedPosition.y;
	mvPosition.xy += rotatedPosition;
	gl_Position = projectionMatrix * mvPosition;
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,sprite_frag:`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
}`},$={common:{diffuse:{value:new sg(16777215)},opacity:{value:1},map:{value:null},mapTransform:{value:new ah},alphaMap:{value:null},alphaMapTransform:{value:new ah},alphaTest:{value:0}},specularmap:{specularMap:{value:null},specularMapTransform:{value:new ah}},envmap:{envMap:{value:null},envMapRotation:{value:new ah},reflectivity:{value:1},ior:{value:1.5},refractionRatio:{value:.98},dfgLUT:{value:null}},aomap:{aoMap:{value:null},aoMapIntensity:{value:1},aoMapTransform:{value:new ah}},lightmap:{lightMap:{value:null},lightMapIntensity:{value:1},lightMapTransform:{value:new ah}},bumpmap:{bumpMap:{value:null},bumpMapTransform:{value:new ah},bumpScale:{value:1}},normalmap:{normalMap:{value:null},normalMapTransform:{value:new ah},normalScale:{value:new Z(1,1)}},displacementmap:{displacementMap:{value:null},displacementMapTransform:{value:new ah},displacementScale:{value:1},displacementBias:{value:0}},emissivemap:{emissiveMap:{value:null},emissiveMapTransform:{value:new ah}},metalnessmap:{metalnessMap:{value:null},metalnessMapTransform:{value:new ah}},roughnessmap:{roughnessMap:{value:null},roughnessMapTransform:{value:new ah}},gradientmap:{gradientMap:{value:null}},fog:{fogDensity:{value:25e-5},fogNear:{value:1},fogFar:{value:2e3},fogColor:{value:new sg(16777215)}},lights:{ambientLightColor:{value:[]},lightProbe:{value:[]},sunLights:{value:[],properties:{direction:{},color:{}}},sunLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},sunShadowMatrix:{value:[]},sunShadowCascade:{value:[]},directionalLights:{value:[],properties:{direction:{},color:{}}},directionalLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},directionalShadowMatrix:{value:[]},spotLights:{value:[],properties:{color:{},position:{},direction:{},distance:{},coneCos:{},penumbraCos:{},decay:{}}},spotLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},spotLightMap:{value:[]},spotLightMatrix:{value:[]},pointLights:{value:[],properties:{color:{},position:{},decay:{},distance:{}}},pointLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{},shadowCameraNear:{},shadowCameraFar:{}}},pointShadowMatrix:{value:[]},hemisphereLights:{value:[],properties:{direction:{},skyColor:{},groundColor:{}}},rectAreaLights:{value:[],properties:{color:{},position:{},width:{},height:{}}},ltc_1:{value:null},ltc_2:{value:null},probesSH:{value:[]},probesMin:{value:[]},probesMax:{value:[]},probesResolution:{value:[]}},points:{diffuse:{value:new sg(16777215)},opacity:{value:1},size:{value:1},scale:{value:1},map:{value:null},alphaMap:{value:null},alphaMapTransform:{value:new ah},alphaTest:{value:0},uvTransform:{value:new ah}},sprite:{diffuse:{value:new sg(16777215)},opacity:{value:1},center:{value:new Z(.5,.5)},rotation:{value:0},map:{value:null},mapTransform:{value:new ah},alphaMap:{value:null},alphaMapTransform:{value:new ah},alphaTest:{value:0}}},lx={basic:{uniforms:zy([$.common,$.specularmap,$.envmap,$.aomap,$.lightmap,$.fog]),vertexShader:cx.meshbasic_vert,fragmentShader:cx.meshbasic_frag},lambert:{uniforms:zy([$.common,$.specularmap,$.envmap,$.aomap,$.lightmap,$.emissivemap,$.bumpmap,$.normalmap,$.displacementmap,$.fog,$.lights,{emissive:{value:new sg(0)},envMapIntensity:{value:1}}]),vertexShader:cx.meshlambert_vert,fragmentShader:cx.meshlambert_frag},phong:{uniforms:zy([$.common,$.specularmap,$.envmap,$.aomap,$.lightmap,$.emissivemap,$.bumpmap,$.normalmap,$.displacementmap,$.fog,$.lights,{emissive:{value:new sg(0)},specular:{value:new sg(1118481)},shininess:{value:30},envMapIntensity:{value:1}}]),vertexShader:cx.meshphong_vert,fragmentShader:cx.meshphong_frag},standard:{uniforms:zy([$.common,$.envmap,$.aomap,$.lightmap,$.emissivemap,$.bumpmap,$.normalmap,$.displacementmap,$.roughnessmap,$.metalnessmap,$.fog,$.lights,{emissive:{value:new sg(0)},roughness:{value:1},metalness:{value:0},envMapIntensity:{value:1}}]),vertexShader:cx.meshphysical_vert,fragmentShader:cx.meshphysical_frag},toon:{uniforms:zy([$.common,$.aomap,$.lightmap,$.emissivemap,$.bumpmap,$.normalmap,$.displacementmap,$.gradientmap,$.fog,$.lights,{emissive:{value:new sg(0)}}]),vertexShader:cx.meshtoon_vert,fragmentShader:cx.meshtoon_frag},matcap:{uniforms:zy([$.common,$.bumpmap,$.normalmap,$.displacementmap,$.fog,{matcap:{value:null}}]),vertexShader:cx.meshmatcap_vert,fragmentShader:cx.meshmatcap_frag},points:{uniforms:zy([$.points,$.fog]),vertexShader:cx.points_vert,fragmentShader:cx.points_frag},dashed:{uniforms:zy([$.common,$.fog,{scale:{value:1},dashSize:{value:1},totalSize:{value:2}}]),vertexShader:cx.linedashed_vert,fragmentShader:cx.linedashed_frag},depth:{uniforms:zy([$.common,$.displacementmap]),vertexShader:cx.depth_vert,fragmentShader:cx.depth_frag},normal:{uniforms:zy([$.common,$.bumpmap,$.normalmap,$.displacementmap,{opacity:{value:1}}]),vertexShader:cx.meshnormal_vert,fragmentShader:cx.meshnormal_frag},sprite:{uniforms:zy([$.sprite,$.fog]),vertexShader:cx.sprite_vert,fragmentShader:cx.sprite_frag},background:{uniforms:{uvTransform:{value:new ah},t2D:{value:null},backgroundIntensity:{value:1}},vertexShader:cx.background_vert,fragmentShader:cx.background_frag},backgroundCube:{uniforms:{envMap:{value:null},backgroundBlurriness:{value:0},backgroundIntensity:{value:1},backgroundRotation:{value:new ah}},vertexShader:cx.backgroundCube_vert,fragmentShader:cx.backgroundCube_frag},cube:{uniforms:{tCube:{value:null},tFlip:{value:-1},opacity:{value:1}},vertexShader:cx.cube_vert,fragmentShader:cx.cube_frag},equirect:{uniforms:{tEquirect:{value:null}},vertexShader:cx.equirect_vert,fragmentShader:cx.equirect_frag},distance:{uniforms:zy([$.common,$.displacementmap,{referencePosition:{value:new Q},nearDistance:{value:1},farDistance:{value:1e3}}]),vertexShader:cx.distance_vert,fragmentShader:cx.distance_frag},shadow:{uniforms:zy([$.lights,$.fog,{color:{value:new sg(0)},opacity:{value:1}}]),vertexShader:cx.shadow_vert,fragmentShader:cx.shadow_frag}};lx.physical={uniforms:zy([lx.standard.uniforms,{clearcoat:{value:0},clearcoatMap:{value:null},clearcoatMapTransform:{value:new ah},clearcoatNormalMap:{value:null},clearcoatNormalMapTransform:{value:new ah},clearcoatNormalScale:{value:new Z(1,1)},clearcoatRoughness:{value:0},clearcoatRoughnessMap:{value:null},clearcoatRoughnessMapTransform:{value:new ah},diffuseRoughness:{value:0},diffuseRoughnessMap:{value:null},diffuseRoughnessMapTransform:{value:new ah},dispersion:{value:0},retroreflectivity:{value:0},iridescence:{value:0},iridescenceMap:{value:null},iridescenceMapTransform:{value:new ah},iridescenceIOR:{value:1.3},iridescenceThicknessMinimum:{value:100},iridescenceThicknessMaximum:{value:400},iridescenceThicknessMap:{value:null},iridescenceThicknessMapTransform:{value:new ah},sheen:{value:0},sheenColor:{value:new sg(0)},sheenColorMap:{value:null},sheenColorMapTransform:{value:new ah},sheenRoughness:{value:1},sheenRoughnessMap:{value:null},sheenRoughnessMapTransform:{value:new ah},transmission:{value:0},transmissionMap:{value:null},transmissionMapTransform:{value:new ah},transmissionSamplerSize:{value:new Z},transmissionSamplerMap:{value:null},thickness:{value:0},thicknessMap:{value:null},thicknessMapTransform:{value:new ah},attenuationDistance:{value:0},attenuationColor:{value:new sg(0)},specularColor:{value:new sg(1,1,1)},specularColorMap:{value:null},specularColorMapTransform:{value:new ah},specularIntensity:{value:1},specularIntensityMap:{value:null},specularIntensityMapTransform:{value:new ah},anisotropyVector:{value:new Z},anisotropyMap:{value:null},anisotropyMapTransform:{value:new ah}}]),vertexShader:cx.meshphysical_vert,fragmentShader:cx.meshphysical_frag};var ux={r:0,b:0,g:0},dx=new Eh,fx=new ah;fx.set(-1,0,0,0,1,0,0,0,1);function px(e,t,n,r,i,a){let o=new sg(0),s=i===!0?0:1,c,l,u=null,d=0,f=null;function p(e){let n=e.isScene===!0?e.background:null;if(n&&n.isTexture){let r=e.backgroundBlurriness>0;n=t.get(n,r)}return n}function m(t){let r=!1,i=p(t);i===null?g(o,s):i&&i.isColor&&(g(i,1),r=!0);let c=e.xr.getEnvironmentBlendMode();c===`additive`?n.buffers.color.setClear(0,0,0,1,a):c===`alpha-blend`&&n.buffers.color.setClear(0,0,0,0,a),(e.autoClear||r)&&(n.buffers.depth.setTest(!0),n.buffers.depth.setMask(!0),n.buffers.color.setMask(!0),e.clear(e.autoClearColor,e.autoClearDepth,e.autoClearStencil))}function h(t,n){let i=p(n);i&&i.isCubeTexture?(l===void 0&&(l=new q_(new vv(1,1,1),new Ky({name:`BackgroundCubeMaterial`,uniforms:Ry(lx.backgroundCube.uniforms),vertexShader:lx.backgroundCube.vertexShader,fragmentShader:lx.backgroundCube.fragmentShader,side:1,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),l.geometry.deleteAttribute(`normal`),l.geometry.deleteAttribute(`uv`),l.onBeforeRender=function(e,t,n){this.matrixWorld.copyPosition(n.matrixWorld)},Object.defineProperty(l.material,"envMap",{get:function(){return this.uniforms.envMap.value}}),r.update(l)),l.material.uniforms.envMap.value=i,l.material.uniforms.backgroundBlurriness.value=n.backgroundBlurriness,l.material.uniforms.backgroundIntensity.value=n.backgroundIntensity,l.material.uniforms.backgroundRotation.value.setFromMatrix4(dx.makeRotationFromEuler(n.backgroundRotation)).transpose(),i.isRenderTargetTexture===!1&&l.material.uniforms.backgroundRotation.value.premultiply(fx),l.material.toneMapped=uh.getTransfer(i.colorSpace)!==dm,(u!==i||d!==i.version||f!==e.toneMapping)&&(l.material.needsUpdate=!0,u=i,d=i.version,f=e.toneMapping),l.layers.enableAll(),t.unshift(l,l.geometry,l.material,0,0,null)):i&&i.isTexture&&(c===void 0&&(c=new q_(new Fy(2,2),new Ky({name:`BackgroundMaterial`,uniforms:Ry(lx.background.uniforms),vertexShader:lx.background.vertexShader,fragmentShader:lx.background.fragmentShader,side:0,depthTest:!1,depthWrite:!1,fog:!1,allowOverride:!1})),c.geometry.deleteAttribute(`normal`),Object.defineProperty(c.material,"map",{get:function(){return this.uniforms.t2D.value}}),r.update(c)),c.material.uniforms.t2D.value=i,c.material.uniforms.backgroundIntensity.value=n.backgroundIntensity,c.material.toneMapped=uh.getTransfer(i.colorSpace)!==dm,i.matrixAutoUpdate===!0&&i.updateMatrix(),c.material.uniforms.uvTransform.value.copy(i.matrix),(u!==i||d!==i.version||f!==e.toneMapping)&&(c.material.needsUpdate=!0,u=i,d=i.version,f=e.toneMapping),c.layers.enableAll(),t.unshift(c,c.geometry,c.material,0,0,null))}function g(t,r){t.getRGB(ux,Hy(e)),n.buffers.color.setClear(ux.r,ux.g,ux.b,r,a)}function _(){l!==void 0&&(l.geometry.dispose(),l.material.dispose(),l=void 0),c!==void 0&&(c.geometry.dispose(),c.material.dispose(),c=void 0)}return{getClearColor:function(){return o},setClearColor:function(e,t=1){o.set(e),s=t,g(o,s)},getClearAlpha:function(){return s},setClearAlpha:function(e){s=e,g(o,s)},render:m,addToRenderList:h,dispose:_}}function mx(e,t){let n=e.getParameter(e.MAX_VERTEX_ATTRIBS),r={},i=f(null),a=i,o=!1;function s(n,r,i,s,c){let u=!1,f=d(n,s,i,r);a!==f&&(a=f,l(a.object)),u=p(n,s,i,c),u&&m(n,s,i,c),c!==null&&t.update(c,e.ELEMENT_ARRAY_BUFFER),(u||o)&&(o=!1,b(n,r,i,s),c!==null&&e.bindBuffer(e.ELEMENT_ARRAY_BUFFER,t.get(c).buffer))}function c(){return e.createVertexArray()}function l(t){return e.bindVertexArray(t)}function u(t){return e.deleteVertexArray(t)}function d(e,t,n,i){let a=i.wireframe===!0,o=r[t.id];o===void 0&&(o={},r[t.id]=o);let s=e.isInstancedMesh===!0?e.id:0,l=o[s];l===void 0&&(l={},o[s]=l);let u=l[n.id];u===void 0&&(u={},l[n.id]=u);let d=u[a];return d===void 0&&(d=f(c()),u[a]=d),d}function f(e){let t=[],r=[],i=[];for(let e=0;e<n;e++)t[e]=0,r[e]=0,i[e]=0;return{geometry:null,program:null,wireframe:!1,newAttributes:t,enabledAttributes:r,attributeDivisors:i,object:e,attributes:{},index:null}}function p(e,t,n,r){let i=a.attributes,o=t.attributes,s=0,c=n.getAttributes();for(let t in c)if(c[t].location>=0){let n=i[t],r=o[t];if(r===void 0&&(t===`instanceMatrix`&&e.instanceMatrix&&(r=e.instanceMatrix),t===`instanceColor`&&e.instanceColor&&(r=e.instanceColor)),n===void 0||n.attribute!==r||r&&n.data!==r.data)return!0;s++}return a.attributesNum!==s||a.index!==r}function m(e,t,n,r){let i={},o=t.attributes,s=0,c=n.getAttributes();for(let t in c)if(c[t].location>=0){let n=o[t];n===void 0&&(t===`instanceMatrix`&&e.instanceMatrix&&(n=e.instanceMatrix),t===`instanceColor`&&e.instanceColor&&(n=e.instanceColor));let r={};r.attribute=n,n&&n.data&&(r.data=n.data),i[t]=r,s++}a.attributes=i,a.attributesNum=s,a.index=r}function h(){let e=a.newAttributes;for(let t=0,n=e.length;t<n;t++)e[t]=0}function g(e){_(e,0)}function _(t,n){let r=a.newAttributes,i=a.enabledAttributes,o=a.attributeDivisors;r[t]=1,i[t]===0&&(e.enableVertexAttribArray(t),i[t]=1),o[t]!==n&&(e.vertexAttribDivisor(t,n),o[t]=n)}function v(){let t=a.newAttributes,n=a.enabledAttributes;for(let r=0,i=n.length;r<i;r++)n[r]!==t[r]&&(e.disableVertexAttribArray(r),n[r]=0)}function y(t,n,r,i,a,o,s){s===!0?e.vertexAttribIPointer(t,n,r,a,o):e.vertexAttribPointer(t,n,r,i,a,o)}function b(n,r,i,a){h();let o=a.attributes,s=i.getAttributes(),c=r.defaultAttributeValues;for(let r in s){let i=s[r];if(i.location>=0){let s=o[r];if(s===void 0&&(r===`instanceMatrix`&&n.instanceMatrix&&(s=n.instanceMatrix),r===`instanceColor`&&n.instanceColor&&(s=n.instanceColor)),s!==void 0){let r=s.normalized,o=s.itemSize,c=t.get(s);if(c===void 0)continue;let l=c.buffer,u=c.type,d=c.bytesPerElement,f=u===e.INT||u===e.UNSIGNED_INT||s.gpuType===1013;if(s.isInterleavedBufferAttribute){let t=s.data,c=t.isInterleavedBuffer===!0?t.stride:t.itemSize,p=s.offset;if(t.isInstancedInterleavedBuffer||t.isInstancedBufferAttribute){for(let e=0;e<i.locationSize;e++)_(i.location+e,t.meshPerAttribute);n.isInstancedMesh!==!0&&a._maxInstanceCount===void 0&&(a._maxInstanceCount=t.meshPerAttribute*t.count)}else for(let e=0;e<i.locationSize;e++)g(i.location+e);e.bindBuffer(e.ARRAY_BUFFER,l);for(let e=0;e<i.locationSize;e++)y(i.location+e,o/i.locationSize,u,r,c*d,(p+o/i.locationSize*e)*d,f)}else{if(s.isInstancedBufferAttribute){for(let e=0;e<i.locationSize;e++)_(i.location+e,s.meshPerAttribute);n.isInstancedMesh!==!0&&a._maxInstanceCount===void 0&&(a._maxInstanceCount=s.meshPerAttribute*s.count)}else for(let e=0;e<i.locationSize;e++)g(i.location+e);e.bindBuffer(e.ARRAY_BUFFER,l);for(let e=0;e<i.locationSize;e++)y(i.location+e,o/i.locationSize,u,r,o*d,o/i.locationSize*e*d,f)}}else if(c!==void 0){let t=c[r];if(t!==void 0)switch(t.length){case 2:e.vertexAttrib2fv(i.location,t);break;case 3:e.vertexAttrib3fv(i.location,t);break;case 4:e.vertexAttrib4fv(i.location,t);break;default:e.vertexAttrib1fv(i.location,t)}}}}v()}function x(){T();for(let e in r){let t=r[e];for(let e in t){let n=t[e];for(let e in n){let t=n[e];for(let e in t)u(t[e].object),delete t[e];delete n[e]}}delete r[e]}}function S(e){if(r[e.id]===void 0)return;let t=r[e.id];for(let e in t){let n=t[e];for(let e in n){let t=n[e];for(let e in t)u(t[e].object),delete t[e];delete n[e]}}delete r[e.id]}function C(e){for(let t in r){let n=r[t];for(let t in n){let r=n[t];if(r[e.id]===void 0)continue;let i=r[e.id];for(let e in i)u(i[e].object),delete i[e];delete r[e.id]}}}function w(e){for(let t in r){let n=r[t],i=e.isInstancedMesh===!0?e.id:0,a=n[i];if(a!==void 0){for(let e in a){let t=a[e];for(let e in t)u(t[e].object),delete t[e];delete a[e]}delete n[i],Object.keys(n).length===0&&delete r[t]}}}function T(){E(),o=!0,a!==i&&(a=i,l(a.object))}function E(){i.geometry=null,i.program=null,i.wireframe=!1}return{setup:s,reset:T,resetDefaultState:E,dispose:x,releaseStatesOfGeometry:S,releaseStatesOfObject:w,releaseStatesOfProgram:C,initAttributes:h,enableAttribute:g,disableUnusedAttributes:v}}function hx(e,t,n){let r;function i(e){r=e}function a(t,i){e.drawArrays(r,t,i),n.update(i,r,1)}function o(t,i,a){a!==0&&(e.drawArraysInstanced(r,t,i,a),n.update(i,r,a))}function s(e,i,a){if(a===0)return;t.get(`WEBGL_multi_draw`).multiDrawArraysWEBGL(r,e,0,i,0,a);let o=0;for(let e=0;e<a;e++)o+=i[e];n.update(o,r,1)}this.setMode=i,this.render=a,this.renderInstances=o,this.renderMultiDraw=s}function gx(e,t,n,r){let i;function a(){if(i!==void 0)return i;if(t.has(`EXT_texture_filter_anisotropic`)===!0){let n=t.get(`EXT_texture_filter_anisotropic`);i=e.getParameter(n.MAX_TEXTURE_MAX_ANISOTROPY_EXT)}else i=0;return i}function o(t){return t===1023||r.convert(t)===e.getParameter(e.IMPLEMENTATION_COLOR_READ_FORMAT)}function s(n){let i=n===1016&&(t.has(`EXT_color_buffer_half_float`)||t.has(`EXT_color_buffer_float`));return!(n!==1009&&n!==1015&&!i&&r.convert(n)!==e.getParameter(e.IMPLEMENTATION_COLOR_READ_TYPE))}function c(t){if(t===`highp`){if(e.getShaderPrecisionFormat(e.VERTEX_SHADER,e.HIGH_FLOAT).precision>0&&e.getShaderPrecisionFormat(e.FRAGMENT_SHADER,e.HIGH_FLOAT).precision>0)return`highp`;t=`mediump`}return t===`mediump`&&e.getShaderPrecisionFormat(e.VERTEX_SHADER,e.MEDIUM_FLOAT).precision>0&&e.getShaderPrecisionFormat(e.FRAGMENT_SHADER,e.MEDIUM_FLOAT).precision>0?`mediump`:`lowp`}let l=n.precision===void 0?`highp`:n.precision,u=c(l);u!==l&&(Sm(`WebGLRenderer:`,l,`not supported, using`,u,`instead.`),l=u);let d=n.reversedDepthBuffer===!0&&t.has(`EXT_clip_control`),f=n.logarithmicDepthBuffer===!0&&d===!1;n.reversedDepthBuffer===!0&&d===!1&&Sm(`WebGLRenderer: Unable to use reversed depth buffer due to missing EXT_clip_control extension. Fallback to default depth buffer.`),n.logarithmicDepthBuffer===!0&&d===!0&&Sm(`WebGLRenderer: Logarithmic depth buffer is ignored when reversed depth buffer is enabled.`);let p=e.getParameter(e.MAX_TEXTURE_IMAGE_UNITS),m=e.getParameter(e.MAX_VERTEX_TEXTURE_IMAGE_UNITS),h=e.getParameter(e.MAX_TEXTURE_SIZE),g=e.getParameter(e.MAX_CUBE_MAP_TEXTURE_SIZE),_=e.getParameter(e.MAX_VERTEX_ATTRIBS),v=e.getParameter(e.MAX_VERTEX_UNIFORM_VECTORS),y=e.getParameter(e.MAX_VARYING_VECTORS),b=e.getParameter(e.MAX_FRAGMENT_UNIFORM_VECTORS),x=e.getParameter(e.MAX_SAMPLES),S=e.getParameter(e.SAMPLES);return{isWebGL2:!0,getMaxAnisotropy:a,getMaxPrecision:c,textureFormatReadable:o,textureTypeReadable:s,precision:l,logarithmicDepthBuffer:f,reversedDepthBuffer:d,maxTextures:p,maxVertexTextures:m,maxTextureSize:h,maxCubemapSize:g,maxAttributes:_,maxVertexUniforms:v,maxVaryings:y,maxFragmentUniforms:b,maxSamples:x,samples:S}}function _x(e){let t=this,n=null,r=0,i=!1,a=!1,o=new d_,s=new ah,c={value:null,needsUpdate:!1};this.uniform=c,this.numPlanes=0,this.numIntersection=0,this.init=function(e,t){let n=e.length!==0||t||r!==0||i;return i=t,r=e.length,n},this.beginShadows=function(){a=!0,u(null)},this.endShadows=function(){a=!1},this.setGlobalState=function(e,t){n=u(e,t,0)},this.setState=function(t,o,s){let d=t.clippingPlanes,f=t.clipIntersection,p=t.clipShadows,m=e.get(t);if(!i||d===null||d.length===0||a&&!p)a?u(null):l();else{let e=a?0:r,t=e*4,i=m.clippingState||null;c.value=i,i=u(d,o,t,s);for(let e=0;e!==t;++e)i[e]=n[e];m.clippingState=i,this.numIntersection=f?this.numPlanes:0,this.numPlanes+=e}};function l(){c.value!==n&&(c.value=n,c.needsUpdate=r>0),t.numPlanes=r,t.numIntersection=0}function u(e,n,r,i){let a=e===null?0:e.length,l=null;if(a!==0){if(l=c.value,i!==!0||l===null){let t=r+a*4,i=n.matrixWorldInverse;s.getNormalMatrix(i),(l===null||l.length<t)&&(l=new Float32Array(t));for(let t=0,n=r;t!==a;++t,n+=4)o.copy(e[t]).applyMatrix4(i,s),o.normal.toArray(l,n),l[n+3]=o.constant}c.value=l,c.needsUpdate=!0}return t.numPlanes=a,t.numIntersection=0,l}}var vx=class extends Ch{constructor(e=1,t={}){super(e,e,t),this.isWebGLCubeRenderTarget=!0;let n={width:e,height:e,depth:1},r=[n,n,n,n,n,n];this.texture=new pv(r),this._setTextureOptions(t),this.texture.isRenderTargetTexture=!0}fromEquirectangularTexture(e,t){this.texture.type=t.type,this.texture.colorSpace=t.colorSpace,this.texture.generateMipmaps=t.generateMipmaps,this.texture.minFilter=t.minFilter,this.texture.magFilter=t.magFilter;let n={uniforms:{tEquirect:{value:null}},vertexShader:`

				varying vec3 vWorldDirection;

				vec3 transformDirection( in vec3 dir, in mat4 matrix ) {

					return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );

				}

				void main() {

					vWorldDirection = transformDirection( position, modelMatrix );

					#include <begin_vertex>
					#include <project_vertex>

				}
			`,fragmentShader:`

				uniform sampler2D tEquirect;

				varying vec3 vWorldDirection;

				#include <common>

				void main() {

					vec3 direction = normalize( vWorldDirection );

					vec2 sampleUV = equirectUv( direction );

					gl_FragColor = texture2D( tEquirect, sampleUV );

				}
			`},r=new vv(5,5,5),i=new Ky({name:`CubemapFromEquirect`,uniforms:Ry(n.uniforms),vertexShader:n.vertexShader,fragmentShader:n.fragmentShader,side:1,blending:0});i.uniforms.tEquirect.value=t;let a=new q_(r,i),o=t.minFilter;return t.minFilter===1008&&(t.minFilter=Kf),new Rb(1,10,this).update(e,a),t.minFilter=o,a.geometry.dispose(),a.material.dispose(),this}clear(e,t=!0,n=!0,r=!0){let i=e.getRenderTarget();for(let i=0;i<6;i++)e.setRenderTarget(this,i),e.clear(t,n,r);e.setRenderTarget(i)}},yx=256,bx=3,xx=20,Sx=256,Cx=16,wx=3,Tx=new Q,Ex=new sg,Dx=class e{constructor(e){this._renderer=e,this._cubeSize=0,this._sourceTarget=null,this._cubeCamera=new Rb(1,10,null),this._boxMesh=new q_(new vv(5,5,5),null),this._cubemapMaterial=null,this._equirectMaterial=null,this._blurMaterial=null,this._ggxMaterial=null,this._integrationMaterial=null}fromScene(e,t=0,n=.1,r=100,i={}){let{size:a=256,position:o=Tx}=i,s=this._renderer;this._setSize(a);let c=this._allocateTarget(),l=this._getSourceTarget(!0);t>0&&(l.texture.mipmapsAutoUpdate=!1);let u=s.autoClear,d=s.autoClearColor,f=s.autoClearDepth,p=s.autoClearStencil,m=e.background;s.autoClear=!0,s.autoClearColor=!0,s.autoClearDepth=!0,s.autoClearStencil=!0,m===null&&(e.background=s.getClearColor(Ex));let h=new Rb(n,r,l);return h.position.copy(o),h.update(s,e),s.autoClear=u,s.autoClearColor=d,s.autoClearDepth=f,s.autoClearStencil=p,e.background=m,t>0&&(l.texture.mipmapsAutoUpdate=!0,this._blur(c,t)),this._applyPMREM(c),c}fromEquirectangular(e,t=null){return this._fromTexture(e,t)}fromCubemap(e,t=null){return this._fromTexture(e,t)}compileCubemapShader(){this._cubemapMaterial===null&&(this._cubemapMaterial=Px(),this._compileMaterial(this._cubemapMaterial))}compileEquirectangularShader(){this._equirectMaterial===null&&(this._equirectMaterial=Nx(),this._compileMaterial(this._equirectMaterial))}dispose(){this._sourceTarget!==null&&this._sourceTarget.dispose(),this._cubemapMaterial!==null&&this._cubemapMaterial.dispose(),this._equirectMaterial!==null&&this._equirectMaterial.dispose(),this._blurMaterial!==null&&this._blurMaterial.dispose(),this._ggxMaterial!==null&&this._ggxMaterial.dispose(),this._integrationMaterial!==null&&this._integrationMaterial.dispose(),this._boxMesh.geometry.dispose()}static lodToRoughness(e,t){return t>0?1-Math.sqrt(1-e/t):0}_setSize(e){this._cubeSize=Math.max(yx,Xm(e))}_fromTexture(e,t){e.mapping===301||e.mapping===302?this._setSize(e.image.length===0?yx:e.image[0].width||e.image[0].image.width):this._setSize(e.image.width/4);let n=t||this._allocateTarget();return this._textureToCubemap(e),this._applyPMREM(n),n}_allocateTarget(){let e=this._cubeSize,t=Ox(e,!1,!1),n=Math.log2(e)-bx;for(let r=0;r<=n;r++)t.texture.mipmaps.push({width:e>>r,height:e>>r});return t.texture.name=`PMREM`,t.texture.isPMREMTexture=!0,t}_getSourceTarget(e=!1){let t=this._cubeSize,n=this._sourceTarget;return(n===null||n.width!==t||e&&n.depthBuffer===!1)&&(n!==null&&n.dispose(),this._sourceTarget=Ox(t,!0,e)),this._sourceTarget}_compileMaterial(e){this._boxMesh.material=e,this._renderer.compile(this._boxMesh,this._cubeCamera.children[0])}_renderCube(e,t,n){let r=this._boxMesh,i=this._cubeCamera;r.material=n,i.renderTarget=e,i.activeMipmapLevel=t;let a=e.width>>t;e.viewport.set(0,0,a,a),i.update(this._renderer,r),e.viewport.set(0,0,e.width,e.height)}_textureToCubemap(e){let t;e.mapping===301||e.mapping===302?(this._cubemapMaterial===null&&(this._cubemapMaterial=Px()),t=this._cubemapMaterial,t.uniforms.flipEnvMap.value=e.isRenderTargetTexture===!1?-1:1):(this._equirectMaterial===null&&(this._equirectMaterial=Nx()),t=this._equirectMaterial),t.uniforms.envMap.value=e,this._renderCube(this._getSourceTarget(),0,t)}_applyPMREM(t){this._ggxMaterial===null&&(this._ggxMaterial=Ax(),this._integrationMaterial=jx());let n=this._cubeSize,r=t.texture.mipmaps.length-1,i=this._ggxMaterial.uniforms;i.envMap.value=this._sourceTarget.texture;let a=this._integrationMaterial.uniforms;a.envMap.value=this._sourceTarget.texture,a.sourceLod.value=Math.log2(n/Cx);for(let o=0;o<=r;o++){let s=e.lodToRoughness(o,r);if(o>r-wx)a.roughness.value=s,this._renderCube(t,o,this._integrationMaterial);else{let e=s>0?Math.log2(n)+.5*Math.log2(6/(Sx*s**4))+.5:0;i.roughness.value=s,i.lodBias.value=e,this._renderCube(t,o,this._ggxMaterial)}}}_blur(e,t){this._blurMaterial===null&&(this._blurMaterial=Mx());let n=this._blurMaterial,r=n.uniforms,i=this._sourceTarget;r.sigma.value=Math.min(t,Math.PI)/Math.SQRT2,r.envMap.value=i.texture,this._renderCube(e,0,n),r.envMap.value=e.texture,this._renderCube(i,0,n)}};function Ox(e,t,n){return new vx(e,{minFilter:Jf,generateMipmaps:t,type:np,colorSpace:lm,depthBuffer:n})}function kx(e,t,n){return new Ky({name:e,uniforms:t,vertexShader:cx.cube_vert,fragmentShader:n,side:1,blending:0,depthTest:!1,depthWrite:!1})}function Ax(){return kx(`PMREMGGXConvolution`,{envMap:{value:null},roughness:{value:0},lodBias:{value:0}},`

		#define GGX_SAMPLES ${Sx}u

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float lodBias;

		#include <common>

		// Van der Corput radical inverse
		float radicalInverse_VdC( uint bits ) {

			bits = ( bits << 16u ) | ( bits >> 16u );
			bits = ( ( bits & 0x55555555u ) << 1u ) | ( ( bits & 0xAAAAAAAAu ) >> 1u );
			bits = ( ( bits & 0x33333333u ) << 2u ) | ( ( bits & 0xCCCCCCCCu ) >> 2u );
			bits = ( ( bits & 0x0F0F0F0Fu ) << 4u ) | ( ( bits & 0xF0F0F0F0u ) >> 4u );
			bits = ( ( bits & 0x00FF00FFu ) << 8u ) | ( ( bits & 0xFF00FF00u ) >> 8u );
			return float( bits ) * 2.3283064365386963e-10; // / 0x100000000

		}

		// Hammersley sequence
		vec2 hammersley( uint i, uint N ) {

			return vec2( float( i ) / float( N ), radicalInverse_VdC( i ) );

		}

		void main() {

			vec3 N = normalize( vWorldDirection );

			// For very low roughness, just sample the environment directly
			if ( roughness < 0.001 ) {

				gl_FragColor = vec4( textureLod( envMap, N, 0.0 ).rgb, 1.0 );
				return;

			}

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			// Tangent space basis for VNDF sampling
			vec3 up = abs( N.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, N ) );
			vec3 bitangent = cross( N, tangent );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			for ( uint i = 0u; i < GGX_SAMPLES; i ++ ) {

				vec2 Xi = hammersley( i, GGX_SAMPLES );

				// With V = N, sample the reflected direction directly.
				float invQ = 1.0 / ( 1.0 - Xi.x + alpha2 * Xi.x );
				float NdotL = ( 1.0 - Xi.x - alpha2 * Xi.x ) * invQ;

				if ( NdotL > 0.0 ) {

					float phi = 2.0 * PI * Xi.y;
					float sinTheta = 2.0 * alpha * sqrt( Xi.x * ( 1.0 - Xi.x ) ) * invQ;
					vec3 L = N * NdotL + ( tangent * cos( phi ) + bitangent * sin( phi ) ) * sinTheta;

					// Match the source mip to the sample's solid angle. The terms
					// independent of the sample are precomputed in lodBias.
					float d = alpha2 * invQ;
					float lod = max( log2( d ) + lodBias, 0.0 );

					// Weight by NdotL for the split-sum approximation
					prefilteredColor += textureLod( envMap, L, lod ).rgb * NdotL;
					totalWeight += NdotL;

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function jx(){return kx(`PMREMGGXIntegration`,{envMap:{value:null},roughness:{value:0},sourceLod:{value:0},sourceSize:{value:Cx}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float roughness;
		uniform float sourceLod;
		uniform int sourceSize;

		void main() {

			vec3 N = normalize( vWorldDirection );

			float alpha = roughness * roughness;
			float alpha2 = alpha * alpha;

			float texelSize = 2.0 / float( sourceSize );

			vec3 prefilteredColor = vec3( 0.0 );
			float totalWeight = 0.0;

			// Pair opposite texels: only the one in N's hemisphere contributes.
			for ( int face = 0; face < 3; face ++ ) {

				for ( int y = 0; y < sourceSize; y ++ ) {

					for ( int x = 0; x < sourceSize; x ++ ) {

						vec2 uv = ( vec2( x, y ) + 0.5 ) * texelSize - 1.0;
						vec3 texelDirection = face == 0 ? vec3( 1.0, uv ) : ( face == 1 ? vec3( uv.x, 1.0, uv.y ) : vec3( uv, 1.0 ) );

						float invDistance = inversesqrt( 1.0 + dot( uv, uv ) );
						float NdotL = dot( N, texelDirection );
						texelDirection *= NdotL < 0.0 ? - 1.0 : 1.0;
						NdotL = abs( NdotL ) * invDistance;

						// With V = N, NdotH squared is ( 1 + NdotL ) / 2. Common factors
						// in the GGX distribution and texel solid angle cancel when normalized.
						float d = 1.0 + alpha2 + ( alpha2 - 1.0 ) * NdotL;
						float weight = NdotL * invDistance * invDistance * invDistance / ( d * d );

						prefilteredColor += textureLod( envMap, texelDirection, sourceLod ).rgb * weight;
						totalWeight += weight;

					}

				}

			}

			gl_FragColor = vec4( prefilteredColor / totalWeight, 1.0 );

		}
	`)}function Mx(){return kx(`PMREMSphericalGaussianBlur`,{envMap:{value:null},sigma:{value:0}},`

		#define SAMPLES ${xx}
		#define GOLDEN_ANGLE 2.39996322973

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float sigma;

		#include <common>

		void main() {

			vec3 outputDirection = normalize( vWorldDirection );

			vec3 up = abs( outputDirection.z ) < 0.999 ? vec3( 0.0, 0.0, 1.0 ) : vec3( 1.0, 0.0, 0.0 );
			vec3 tangent = normalize( cross( up, outputDirection ) );
			vec3 bitangent = cross( outputDirection, tangent );

			// Truncate the kernel at three standard deviations or at the antipode.
			float thetaMax = min( 3.0 * sigma, PI );
			float truncation = 1.0 - exp( - 0.5 * thetaMax * thetaMax / ( sigma * sigma ) );

			vec3 accumColor = vec3( 0.0 );
			float accumWeight = 0.0;

			for ( int i = 0; i < SAMPLES; i ++ ) {

				// Stratified inverse-CDF sampling of the Gaussian, placed on a golden-angle spiral.
				float stratum = ( float( i ) + 0.5 ) / float( SAMPLES );
				float theta = sigma * sqrt( - 2.0 * log( 1.0 - stratum * truncation ) );
				float phi = float( i ) * GOLDEN_ANGLE;

				vec3 offset = cos( phi ) * tangent + sin( phi ) * bitangent;
				vec3 sampleDirection = cos( theta ) * outputDirection + sin( theta ) * offset;

				// Correct the planar sample density to solid angle.
				float weight = sin( theta ) / theta;

				accumColor += weight * textureLod( envMap, sampleDirection, 0.0 ).rgb;
				accumWeight += weight;

			}

			gl_FragColor = vec4( accumColor / accumWeight, 1.0 );

		}
	`)}function Nx(){return kx(`PMREMEquirectangularToCubemap`,{envMap:{value:null}},`

		varying vec3 vWorldDirection;

		uniform sampler2D envMap;

		#include <common>

		void main() {

			// Average four subpixel samples to preserve small, bright features.
			vec3 direction = normalize( vWorldDirection );
			vec3 dx = dFdx( direction ) * 0.25;
			vec3 dy = dFdy( direction ) * 0.25;

			vec3 color = textureLod( envMap, equirectUv( normalize( direction - dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx - dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction - dx + dy ) ), 0.0 ).rgb;
			color += textureLod( envMap, equirectUv( normalize( direction + dx + dy ) ), 0.0 ).rgb;
			gl_FragColor = vec4( color * 0.25, 1.0 );

		}
	`)}function Px(){return kx(`PMREMCubemapToCubemap`,{envMap:{value:null},flipEnvMap:{value:-1}},`

		varying vec3 vWorldDirection;

		uniform samplerCube envMap;
		uniform float flipEnvMap;

		void main() {

			gl_FragColor = vec4( textureCube( envMap, vec3( flipEnvMap * vWorldDirection.x, vWorldDirection.yz ) ).rgb, 1.0 );

		}
	`)}function Fx(e){let t=new WeakMap,n=new WeakMap,r=null;function i(e,t=!1){return e==null?null:t?o(e):a(e)}function a(n){if(n&&n.isTexture){let r=n.mapping;if(r===303||r===304){if(t.has(n)){let e=t.get(n).texture;return s(e,n.mapping)}{let r=n.image;if(r&&r.height>0){let i=new vx(r.height);return i.fromEquirectangularTexture(e,n),t.set(n,i),n.addEventListener(`dispose`,l),s(i.texture,n.mapping)}return null}}}return n}function o(t){if(t&&t.isTexture&&t.isPMREMTexture!==!0){let i=t.mapping,a=i===303||i===304,o=i===301||i===302;if(a||o){let i=n.get(t),s=i===void 0?0:i.texture.pmremVersion;if(t.isRenderTargetTexture&&t.pmremVersion!==s)return r===null&&(r=new Dx(e)),i=a?r.fromEquirectangular(t,i):r.fromCubemap(t,i),i.texture.pmremVersion=t.pmremVersion,n.set(t,i),i.texture;if(i!==void 0)return i.texture;{let s=t.image;return a&&s&&s.height>0||o&&s&&c(s)?(r===null&&(r=new Dx(e)),i=a?r.fromEquirectangular(t):r.fromCubemap(t),i.texture.pmremVersion=t.pmremVersion,n.set(t,i),t.addEventListener(`dispose`,u),i.texture):null}}}return t}function s(e,t){return t===303?e.mapping=301:t===304&&(e.mapping=302),e}function c(e){let t=0;for(let n=0;n<6;n++)e[n]!==void 0&&t++;return t===6}function l(e){let n=e.target;n.removeEventListener(`dispose`,l);let r=t.get(n);r!==void 0&&(t.delete(n),r.dispose())}function u(e){let t=e.target;t.removeEventListener(`dispose`,u);let r=n.get(t);r!==void 0&&(n.delete(t),r.dispose())}function d(){t=new WeakMap,n=new WeakMap,r!==null&&(r.dispose(),r=null)}return{get:i,dispose:d}}function Ix(e){let t={};function n(n){if(t[n]!==void 0)return t[n];let r=e.getExtension(n);return t[n]=r,r}return{has:function(e){return n(e)!==null},init:function(){n(`EXT_color_buffer_float`),n(`WEBGL_clip_cull_distance`),n(`OES_texture_float_linear`),n(`EXT_color_buffer_half_float`),n(`WEBGL_multisampled_render_to_texture`),n(`WEBGL_render_shared_exponent`)},get:function(e){let t=n(e);return t===null&&wm(`WebGLRenderer: `+e+` extension not supported.`),t}}}function Lx(e,t,n,r){let i={},a=new WeakMap,o=new FinalizationRegistry(e=>delete i[e]);function s(e){c(e.target)}function c(e){e.index!==null&&t.remove(e.index);for(let n in e.attributes)t.remove(e.attributes[n]);e.removeEventListener(`dispose`,s),delete i[e.id],o.unregister(e);let c=a.get(e);c&&(t.remove(c),a.delete(e)),r.releaseStatesOfGeometry(e),e.isInstancedBufferGeometry===!0&&delete e._maxInstanceCount,n.memory.geometries--}function l(e,t){return i[t.id]===void 0&&(t.addEventListener(`dispose`,s),i[t.id]=new WeakRef(t),o.register(t,t.id,t),n.memory.geometries++),t}function u(n){let r=n.attributes;for(let n in r)t.update(r[n],e.ARRAY_BUFFER)}function d(e){let n=e.index,r=e.attributes.position,i=0;if(r===void 0)return;let o=n===null?r.array.length/3-1:n.array.length,s=new(r.count>=65535?Wg:Ug)(Math.ceil(o/3)*6,1),c=s.array;if(n!==null){let e=n.array;i=n.version;for(let t=0,n=0;t<o;t+=3){let r=e[t+0],i=e[t+1],a=e[t+2];c[n++]=r,c[n++]=i,c[n++]=i,c[n++]=a,c[n++]=a,c[n++]=r}}else{i=r.version;for(let e=0,t=0;e<o;e+=3){let n=e+0,r=e+1,i=e+2;c[t++]=n,c[t++]=r,c[t++]=r,c[t++]=i,c[t++]=i,c[t++]=n}}s.version=i;let l=a.get(e);l&&t.remove(l),a.set(e,s)}function f(e){let t=a.get(e);if(t){let n=e.index;n!==null&&t.version<n.version&&d(e)}else d(e);return a.get(e)}function p(){for(let e in i){let t=i[e].deref();t!==void 0&&c(t)}}return{get:l,update:u,getWireframeAttribute:f,dispose:p}}function Rx(e,t,n){let r;function i(e){r=e}let a,o;function s(e){a=e.type,o=e.bytesPerElement}function c(t,i){e.drawElements(r,i,a,t*o),n.update(i,r,1)}function l(t,i,s){s!==0&&(e.drawElementsInstanced(r,i,a,t*o,s),n.update(i,r,s))}function u(e,i,o){if(o===0)return;t.get(`WEBGL_multi_draw`).multiDrawElementsWEBGL(r,i,0,a,e,0,o);let s=0;for(let e=0;e<o;e++)s+=i[e];n.update(s,r,1)}this.setMode=i,this.setIndex=s,this.render=c,this.renderInstances=l,this.renderMultiDraw=u}function zx(e){let t={geometries:0,textures:0},n={frame:0,calls:0,triangles:0,points:0,lines:0};function r(t,r,i){switch(n.calls++,r){case e.TRIANGLES:n.triangles+=t/3*i;break;case e.LINES:n.lines+=t/2*i;break;case e.LINE_STRIP:n.lines+=i*(t-1);break;case e.LINE_LOOP:n.lines+=i*t;break;case e.POINTS:n.points+=i*t;break;default:Cm(`WebGLInfo: Unknown draw mode:`,r)}}function i(){n.calls=0,n.triangles=0,n.points=0,n.lines=0}return{memory:t,render:n,programs:null,autoReset:!0,reset:i,update:r}}function Bx(e,t,n){let r=new WeakMap,i=new xh;function a(a,o,s){let c=a.morphTargetInfluences,l=o.morphAttributes.position||o.morphAttributes.normal||o.morphAttributes.color,u=l===void 0?0:l.length,d=r.get(o);if(d===void 0||d.count!==u){d!==void 0&&d.texture.dispose();let e=o.morphAttributes.position!==void 0,n=o.morphAttributes.normal!==void 0,a=o.morphAttributes.color!==void 0,s=o.morphAttributes.position||[],c=o.morphAttributes.normal||[],l=o.morphAttributes.color||[],f=0;e===!0&&(f=1),n===!0&&(f=2),a===!0&&(f=3);let p=o.attributes.position.count*f,m=1;p>t.maxTextureSize&&(m=Math.ceil(p/t.maxTextureSize),p=t.maxTextureSize);let h=new Float32Array(p*m*4*u),g=new wh(h,p,m,u);g.type=tp,g.needsUpdate=!0;let _=f*4;for(let t=0;t<u;t++){let r=s[t],o=c[t],u=l[t],d=p*m*4*t;for(let t=0;t<r.count;t++){let s=t*_;e===!0&&(i.fromBufferAttribute(r,t),h[d+s+0]=i.x,h[d+s+1]=i.y,h[d+s+2]=i.z,h[d+s+3]=0),n===!0&&(i.fromBufferAttribute(o,t),h[d+s+4]=i.x,h[d+s+5]=i.y,h[d+s+6]=i.z,h[d+s+7]=0),a===!0&&(i.fromBufferAttribute(u,t),h[d+s+8]=i.x,h[d+s+9]=i.y,h[d+s+10]=i.z,h[d+s+11]=u.itemSize===4?i.w:1)}}d={count:u,texture:g,size:new Z(p,m)},r.set(o,d);function v(){g.dispose(),r.delete(o),o.removeEventListener(`dispose`,v)}o.addEventListener(`dispose`,v)}if(a.isInstancedMesh===!0&&a.morphTexture!==null)s.getUniforms().setValue(e,`morphTexture`,a.morphTexture,n);else{let t=0;for(let e=0;e<c.length;e++)t+=c[e];let n=o.morphTargetsRelative?1:1-t;s.getUniforms().setValue(e,`morphTargetBaseInfluence`,n),s.getUniforms().setValue(e,`morphTargetInfluences`,c)}s.getUniforms().setValue(e,`morphTargetsTexture`,d.texture,n),s.getUniforms().setValue(e,`morphTargetsTextureSize`,d.size)}return{update:a}}function Vx(e,t,n,r,i){let a=new WeakMap;function o(r){let o=i.render.frame,s=r.geometry,l=t.get(r,s);if(a.get(l)!==o&&(t.update(l),a.set(l,o)),r.isInstancedMesh&&(r.hasEventListener(`dispose`,c)===!1&&r.addEventListener(`dispose`,c),a.get(r)!==o&&(n.update(r.instanceMatrix,e.ARRAY_BUFFER),r.instanceColor!==null&&n.update(r.instanceColor,e.ARRAY_BUFFER),a.set(r,o))),r.isSkinnedMesh){let e=r.skeleton;a.get(e)!==o&&(e.update(),a.set(e,o))}return l}function s(){a=new WeakMap}function c(e){let t=e.target;t.removeEventListener(`dispose`,c),r.releaseStatesOfObject(t),n.remove(t.instanceMatrix),t.instanceColor!==null&&n.remove(t.instanceColor)}return{update:o,dispose:s}}var Hx={1:`LINEAR_TONE_MAPPING`,2:`REINHARD_TONE_MAPPING`,3:`CINEON_TONE_MAPPING`,4:`ACES_FILMIC_TONE_MAPPING`,6:`AGX_TONE_MAPPING`,7:`NEUTRAL_TONE_MAPPING`,5:`CUSTOM_TONE_MAPPING`};function Ux(e,t,n,r,i,a){let o=new Ch(t,n,{type:e,depthBuffer:i,stencilBuffer:a,samples:r?4:0,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,resolveDepthBuffer:!1,resolveStencilBuffer:!1}),s=null,c=null,l=null,u=new r_;u.setAttribute(`position`,new Gg([-1,3,0,-1,-1,0,3,-1,0],3)),u.setAttribute(`uv`,new Gg([0,2,0,0,2,0],2));let d=new qy({uniforms:{tDiffuse:{value:null}},vertexShader:`
			precision highp float;

			uniform mat4 modelViewMatrix;
			uniform mat4 projectionMatrix;

			attribute vec3 position;
			attribute vec2 uv;

			varying vec2 vUv;

			void main() {
				vUv = uv;
				gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
			}`,fragmentShader:`
			precision highp float;

			uniform sampler2D tDiffuse;

			varying vec2 vUv;

			#include <tonemapping_pars_fragment>
			#include <colorspace_pars_fragment>

			void main() {
				gl_FragColor = texture2D( tDiffuse, vUv );

				#ifdef LINEAR_TONE_MAPPING
					gl_FragColor.rgb = LinearToneMapping( gl_FragColor.rgb );
				#elif defined( REINHARD_TONE_MAPPING )
					gl_FragColor.rgb = ReinhardToneMapping( gl_FragColor.rgb );
				#elif defined( CINEON_TONE_MAPPING )
					gl_FragColor.rgb = CineonToneMapping( gl_FragColor.rgb );
				#elif defined( ACES_FILMIC_TONE_MAPPING )
					gl_FragColor.rgb = ACESFilmicToneMapping( gl_FragColor.rgb );
				#elif defined( AGX_TONE_MAPPING )
					gl_FragColor.rgb = AgXToneMapping( gl_FragColor.rgb );
				#elif defined( NEUTRAL_TONE_MAPPING )
					gl_FragColor.rgb = NeutralToneMapping( gl_FragColor.rgb );
				#elif defined( CUSTOM_TONE_MAPPING )
					gl_FragColor.rgb = CustomToneMapping( gl_FragColor.rgb );
				#endif

				#ifdef SRGB_TRANSFER
					gl_FragColor = sRGBTransferOETF( gl_FragColor );
				#endif
			}`,depthTest:!1,depthWrite:!1}),f=new q_(u,d),p=new Mb(-1,1,1,-1,0,1),m=null,h=null,g=!1,_,v=null,y=[],b=!1;this.setSize=function(e,t){o.setSize(e,t),s!==null&&s.setSize(e,t),c!==null&&c.setSize(e,t);for(let n=0;n<y.length;n++){let r=y[n];r.setSize&&r.setSize(e,t)}},this.setEffects=function(e){y=e,b=y.length>0&&y[0].isRenderPass===!0;let t=o.width,n=o.height;y.length>0&&s===null&&(s=new Ch(t,n,{type:np,depthBuffer:!1,stencilBuffer:!1}),c=new Ch(t,n,{type:np,depthBuffer:!1,stencilBuffer:!1}));let r=i===!0&&y.some(e=>e.needsDepthTexture===!0);r!==(o.depthTexture!==null)&&(r===!0&&l===null&&(l=new hv(t,n),a===!0&&(l.format=fp,l.type=ap)),o.dispose(),o.depthTexture=r?l:null,o.resolveDepthBuffer=r,o.storeMultisampledDepthBuffer=r);for(let e=0;e<y.length;e++){let i=y[e];i.setSize&&i.setSize(t,n),r&&i.needsDepthTexture===!0&&i.setDepthTexture&&i.setDepthTexture(l)}},this.begin=function(e,t){if(g||e.toneMapping===0&&y.length===0)return!1;if(v=t,t!==null){let e=t.width,n=t.height;(o.width!==e||o.height!==n)&&this.setSize(e,n)}return b===!1&&e.setRenderTarget(o),_=e.toneMapping,e.toneMapping=0,!0},this.hasRenderPass=function(){return b},this.end=function(e,t){e.toneMapping=_,g=!0;let n=o,r=s;for(let i=0;i<y.length;i++){let a=y[i];a.enabled!==!1&&(a.render(e,r,n,t),a.needsSwap!==!1&&(n=r,r=r===s?c:s))}if(m!==e.outputColorSpace||h!==e.toneMapping){m=e.outputColorSpace,h=e.toneMapping,d.defines={},uh.getTransfer(m)===`srgb`&&(d.defines.SRGB_TRANSFER=``);let t=Hx[h];t&&(d.defines[t]=``),d.needsUpdate=!0}d.uniforms.tDiffuse.value=n.texture,e.setRenderTarget(v),e.render(f,p),v=null,g=!1},this.isCompositing=function(){return g},this.dispose=function(){o.dispose(),s!==null&&s.dispose(),c!==null&&c.dispose(),u.dispose(),d.dispose()}}var Wx=new bh,Gx=new hv(1,1),Kx=new gv(1),qx=new wh,Jx=new Th,Yx=new pv,Xx=[],Zx=[],Qx=new Float32Array(16),$x=new Float32Array(9),eS=new Float32Array(4);function tS(e,t,n){let r=e[0];if(r<=0||r>0)return e;let i=t*n,a=Xx[i];if(a===void 0&&(a=new Float32Array(i),Xx[i]=a),t!==0){r.toArray(a,0);for(let r=1,i=0;r!==t;++r)i+=n,e[r].toArray(a,i)}return a}function nS(e,t){if(e.length!==t.length)return!1;for(let n=0,r=e.length;n<r;n++)if(e[n]!==t[n])return!1;return!0}function rS(e,t){for(let n=0,r=t.length;n<r;n++)e[n]=t[n]}function iS(e,t){let n=Zx[t];n===void 0&&(n=new Int32Array(t),Zx[t]=n);for(let r=0;r!==t;++r)n[r]=e.allocateTextureUnit();return n}function aS(e,t){let n=this.cache;n[0]!==t&&(e.uniform1f(this.addr,t),n[0]=t)}function oS(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y)&&(e.uniform2f(this.addr,t.x,t.y),n[0]=t.x,n[1]=t.y);else{if(nS(n,t))return;e.uniform2fv(this.addr,t),rS(n,t)}}function sS(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z)&&(e.uniform3f(this.addr,t.x,t.y,t.z),n[0]=t.x,n[1]=t.y,n[2]=t.z);else if(t.r!==void 0)(n[0]!==t.r||n[1]!==t.g||n[2]!==t.b)&&(e.uniform3f(this.addr,t.r,t.g,t.b),n[0]=t.r,n[1]=t.g,n[2]=t.b);else{if(nS(n,t))return;e.uniform3fv(this.addr,t),rS(n,t)}}function cS(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z||n[3]!==t.w)&&(e.uniform4f(this.addr,t.x,t.y,t.z,t.w),n[0]=t.x,n[1]=t.y,n[2]=t.z,n[3]=t.w);else{if(nS(n,t))return;e.uniform4fv(this.addr,t),rS(n,t)}}function lS(e,t){let n=this.cache,r=t.elements;if(r===void 0){if(nS(n,t))return;e.uniformMatrix2fv(this.addr,!1,t),rS(n,t)}else{if(nS(n,r))return;eS.set(r),e.uniformMatrix2fv(this.addr,!1,eS),rS(n,r)}}function uS(e,t){let n=this.cache,r=t.elements;if(r===void 0){if(nS(n,t))return;e.uniformMatrix3fv(this.addr,!1,t),rS(n,t)}else{if(nS(n,r))return;$x.set(r),e.uniformMatrix3fv(this.addr,!1,$x),rS(n,r)}}function dS(e,t){let n=this.cache,r=t.elements;if(r===void 0){if(nS(n,t))return;e.uniformMatrix4fv(this.addr,!1,t),rS(n,t)}else{if(nS(n,r))return;Qx.set(r),e.uniformMatrix4fv(this.addr,!1,Qx),rS(n,r)}}function fS(e,t){let n=this.cache;n[0]!==t&&(e.uniform1i(this.addr,t),n[0]=t)}function pS(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y)&&(e.uniform2i(this.addr,t.x,t.y),n[0]=t.x,n[1]=t.y);else{if(nS(n,t))return;e.uniform2iv(this.addr,t),rS(n,t)}}function mS(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z)&&(e.uniform3i(this.addr,t.x,t.y,t.z),n[0]=t.x,n[1]=t.y,n[2]=t.z);else{if(nS(n,t))return;e.uniform3iv(this.addr,t),rS(n,t)}}function hS(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z||n[3]!==t.w)&&(e.uniform4i(this.addr,t.x,t.y,t.z,t.w),n[0]=t.x,n[1]=t.y,n[2]=t.z,n[3]=t.w);else{if(nS(n,t))return;e.uniform4iv(this.addr,t),rS(n,t)}}function gS(e,t){let n=this.cache;n[0]!==t&&(e.uniform1ui(this.addr,t),n[0]=t)}function _S(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y)&&(e.uniform2ui(this.addr,t.x,t.y),n[0]=t.x,n[1]=t.y);else{if(nS(n,t))return;e.uniform2uiv(this.addr,t),rS(n,t)}}function vS(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z)&&(e.uniform3ui(this.addr,t.x,t.y,t.z),n[0]=t.x,n[1]=t.y,n[2]=t.z);else{if(nS(n,t))return;e.uniform3uiv(this.addr,t),rS(n,t)}}function yS(e,t){let n=this.cache;if(t.x!==void 0)(n[0]!==t.x||n[1]!==t.y||n[2]!==t.z||n[3]!==t.w)&&(e.uniform4ui(this.addr,t.x,t.y,t.z,t.w),n[0]=t.x,n[1]=t.y,n[2]=t.z,n[3]=t.w);else{if(nS(n,t))return;e.uniform4uiv(this.addr,t),rS(n,t)}}function bS(e){return e.version===0&&(e.compareFunction=519,e.needsUpdate=!0),e}function xS(e,t,n){let r=this.cache,i=n.allocateTextureUnit();r[0]!==i&&(e.uniform1i(this.addr,i),r[0]=i);let a;a=this.type===e.SAMPLER_2D_SHADOW?bS(Gx):Wx,n.setTexture2D(t||a,i)}function SS(e,t,n){let r=this.cache,i=n.allocateTextureUnit();r[0]!==i&&(e.uniform1i(this.addr,i),r[0]=i),n.setTexture3D(t||Jx,i)}function CS(e,t,n){let r=this.cache,i=n.allocateTextureUnit();r[0]!==i&&(e.uniform1i(this.addr,i),r[0]=i);let a;a=this.type===e.SAMPLER_CUBE_SHADOW?bS(Kx):Yx,n.setTextureCube(t||a,i)}function wS(e,t,n){let r=this.cache,i=n.allocateTextureUnit();r[0]!==i&&(e.uniform1i(this.addr,i),r[0]=i),n.setTexture2DArray(t||qx,i)}function TS(e){switch(e){case 5126:return aS;case 35664:return oS;case 35665:return sS;case 35666:return cS;case 35674:return lS;case 35675:return uS;case 35676:return dS;case 5124:case 35670:return fS;case 35667:case 35671:return pS;case 35668:case 35672:return mS;case 35669:case 35673:return hS;case 5125:return gS;case 36294:return _S;case 36295:return vS;case 36296:return yS;case 35678:case 36198:case 36298:case 36306:case 35682:return xS;case 35679:case 36299:case 36307:return SS;case 35680:case 36300:case 36308:case 36293:return CS;case 36289:case 36303:case 36311:case 36292:return wS}}function ES(e,t){e.uniform1fv(this.addr,t)}function DS(e,t){let n=tS(t,this.size,2);e.uniform2fv(this.addr,n)}function OS(e,t){let n=tS(t,this.size,3);e.uniform3fv(this.addr,n)}function kS(e,t){let n=tS(t,this.size,4);e.uniform4fv(this.addr,n)}function AS(e,t){let n=tS(t,this.size,4);e.uniformMatrix2fv(this.addr,!1,n)}function jS(e,t){let n=tS(t,this.size,9);e.uniformMatrix3fv(this.addr,!1,n)}function MS(e,t){let n=tS(t,this.size,16);e.uniformMatrix4fv(this.addr,!1,n)}function NS(e,t){e.uniform1iv(this.addr,t)}function PS(e,t){e.uniform2iv(this.addr,t)}function FS(e,t){e.uniform3iv(this.addr,t)}function IS(e,t){e.uniform4iv(this.addr,t)}function LS(e,t){e.uniform1uiv(this.addr,t)}function RS(e,t){e.uniform2uiv(this.addr,t)}function zS(e,t){e.uniform3uiv(this.addr,t)}function BS(e,t){e.uniform4uiv(this.addr,t)}function VS(e,t,n){let r=this.cache,i=t.length,a=iS(n,i);nS(r,a)||(e.uniform1iv(this.addr,a),rS(r,a));let o;o=this.type===e.SAMPLER_2D_SHADOW?bS(Gx):Wx;for(let e=0;e!==i;++e)n.setTexture2D(t[e]||o,a[e])}function HS(e,t,n){let r=this.cache,i=t.length,a=iS(n,i);nS(r,a)||(e.uniform1iv(this.addr,a),rS(r,a));for(let e=0;e!==i;++e)n.setTexture3D(t[e]||Jx,a[e])}function US(e,t,n){let r=this.cache,i=t.length,a=iS(n,i);nS(r,a)||(e.uniform1iv(this.addr,a),rS(r,a));let o;o=this.type===e.SAMPLER_CUBE_SHADOW?bS(Kx):Yx;for(let e=0;e!==i;++e)n.setTextureCube(t[e]||o,a[e])}function WS(e,t,n){let r=this.cache,i=t.length,a=iS(n,i);nS(r,a)||(e.uniform1iv(this.addr,a),rS(r,a));for(let e=0;e!==i;++e)n.setTexture2DArray(t[e]||qx,a[e])}function GS(e){switch(e){case 5126:return ES;case 35664:return DS;case 35665:return OS;case 35666:return kS;case 35674:return AS;case 35675:return jS;case 35676:return MS;case 5124:case 35670:return NS;case 35667:case 35671:return PS;case 35668:case 35672:return FS;case 35669:case 35673:return IS;case 5125:return LS;case 36294:return RS;case 36295:return zS;case 36296:return BS;case 35678:case 36198:case 36298:case 36306:case 35682:return VS;case 35679:case 36299:case 36307:return HS;case 35680:case 36300:case 36308:case 36293:return US;case 36289:case 36303:case 36311:case 36292:return WS}}var KS=class{constructor(e,t,n){this.id=e,this.addr=n,this.cache=[],this.type=t.type,this.setValue=TS(t.type)}},qS=class{constructor(e,t,n){this.id=e,this.addr=n,this.cache=[],this.type=t.type,this.size=t.size,this.setValue=GS(t.type)}},JS=class{constructor(e){this.id=e,this.seq=[],this.map={}}setValue(e,t,n){let r=this.seq;for(let i=0,a=r.length;i!==a;++i){let a=r[i];a.setValue(e,t[a.id],n)}}},YS=/(\w+)(\])?(\[|\.)?/g;function XS(e,t){e.seq.push(t),e.map[t.id]=t}function ZS(e,t,n){let r=e.name,i=r.length;for(YS.lastIndex=0;;){let a=YS.exec(r),o=YS.lastIndex,s=a[1],c=a[2]===`]`,l=a[3];if(c&&(s|=0),l===void 0||l===`[`&&o+2===i){XS(n,l===void 0?new KS(s,e,t):new qS(s,e,t));break}{let e=n.map[s];e===void 0&&(e=new JS(s),XS(n,e)),n=e}}}var QS=class{constructor(e,t){this.seq=[],this.map={};let n=e.getProgramParameter(t,e.ACTIVE_UNIFORMS);for(let r=0;r<n;++r){let n=e.getActiveUniform(t,r);ZS(n,e.getUniformLocation(t,n.name),this)}let r=[],i=[];for(let t of this.seq)t.type===e.SAMPLER_2D_SHADOW||t.type===e.SAMPLER_CUBE_SHADOW||t.type===e.SAMPLER_2D_ARRAY_SHADOW?r.push(t):i.push(t);r.length>0&&(this.seq=r.concat(i))}setValue(e,t,n,r){let i=this.map[t];i!==void 0&&i.setValue(e,n,r)}setOptional(e,t,n){let r=t[n];r!==void 0&&this.setValue(e,n,r)}static upload(e,t,n,r){for(let i=0,a=t.length;i!==a;++i){let a=t[i],o=n[a.id];o.needsUpdate!==!1&&a.setValue(e,o.value,r)}}static seqWithValue(e,t){let n=[];for(let r=0,i=e.length;r!==i;++r){let i=e[r];i.id in t&&n.push(i)}return n}};function $S(e,t,n){let r=e.createShader(t);return e.shaderSource(r,n),e.compileShader(r),r}var eC=37297,tC=0;function nC(e,t){let n=e.split(`
`),r=[],i=Math.max(t-6,0),a=Math.min(t+6,n.length);for(let e=i;e<a;e++){let i=e+1;r.push(`${i===t?`>`:` `} ${i}: ${n[e]}`)}return r.join(`
`)}var rC=new ah;function iC(e){uh._getMatrix(rC,uh.workingColorSpace,e);let t=`mat3( ${rC.elements.map(e=>e.toFixed(4))} )`;switch(uh.getTransfer(e)){case um:return[t,`LinearTransferOETF`];case dm:return[t,`sRGBTransferOETF`];default:return Sm(`WebGLProgram: Unsupported color space: `,e),[t,`LinearTransferOETF`]}}function aC(e,t,n){let r=e.getShaderParameter(t,e.COMPILE_STATUS),i=(e.getShaderInfoLog(t)||``).trim();if(r&&i===``)return``;let a=/ERROR: 0:(\d+)/.exec(i);if(a){let r=parseInt(a[1]);return n.toUpperCase()+`

`+i+`

`+nC(e.getShaderSource(t),r)}return i}function oC(e,t){let n=iC(t);return[`vec4 ${e}( vec4 value ) {`,`	return ${n[1]}( vec4( ${n[0]} * value.rgb, value.a ) );`,`}`].join(`
`)}var sC={1:`Linear`,2:`Reinhard`,3:`Cineon`,4:`ACESFilmic`,6:`AgX`,7:`Neutral`,5:`Custom`};function cC(e,t){let n=sC[t];return n===void 0?(Sm(`WebGLProgram: Unsupported toneMapping:`,t),`vec3 `+e+`( vec3 color ) { return LinearToneMapping( color ); }`):`vec3 `+e+`( vec3 color ) { return `+n+`ToneMapping( color ); }`}var lC=new Q;function uC(){return uh.getLuminanceCoefficients(lC),[`float luminance( const in vec3 rgb ) {`,`	const vec3 weights = vec3( ${lC.x.toFixed(4)}, ${lC.y.toFixed(4)}, ${lC.z.toFixed(4)} );`,`	return dot( weights, rgb );`,`}`].join(`
`)}function dC(e){return[e.extensionClipCullDistance?`#extension GL_ANGLE_clip_cull_distance : require`:``,e.extensionMultiDraw?`#extension GL_ANGLE_multi_draw : require`:``].filter(mC).join(`
`)}function fC(e){let t=[];for(let n in e){let r=e[n];r!==!1&&t.push(`#define `+n+` `+r)}return t.join(`
`)}function pC(e,t){let n={},r=e.getProgramParameter(t,e.ACTIVE_ATTRIBUTES);for(let i=0;i<r;i++){let r=e.getActiveAttrib(t,i),a=r.name,o=1;r.type===e.FLOAT_MAT2&&(o=2),r.type===e.FLOAT_MAT3&&(o=3),r.type===e.FLOAT_MAT4&&(o=4),n[a]={type:r.type,location:e.getAttribLocation(t,a),locationSize:o}}return n}function mC(e){return e!==``}function hC(e,t){let n=t.numSpotLightShadows+t.numSpotLightMaps-t.numSpotLightShadowsWithMaps;return e.replace(/NUM_SUN_LIGHTS/g,t.numSunLights).replace(/NUM_DIR_LIGHTS/g,t.numDirLights).replace(/NUM_SPOT_LIGHTS/g,t.numSpotLights).replace(/NUM_SPOT_LIGHT_MAPS/g,t.numSpotLightMaps).replace(/NUM_SPOT_LIGHT_COORDS/g,n).replace(/NUM_RECT_AREA_LIGHTS/g,t.numRectAreaLights).replace(/NUM_POINT_LIGHTS/g,t.numPointLights).replace(/NUM_HEMI_LIGHTS/g,t.numHemiLights).replace(/NUM_SUN_LIGHT_SHADOWS/g,t.numSunLightShadows).replace(/NUM_DIR_LIGHT_SHADOWS/g,t.numDirLightShadows).replace(/NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS/g,t.numSpotLightShadowsWithMaps).replace(/NUM_SPOT_LIGHT_SHADOWS/g,t.numSpotLightShadows).replace(/NUM_POINT_LIGHT_SHADOWS/g,t.numPointLightShadows).replace(/NUM_LIGHT_PROBE_GRIDS/g,t.numLightProbeGrids)}function gC(e,t){return e.replace(/NUM_CLIPPING_PLANES/g,t.numClippingPlanes).replace(/UNION_CLIPPING_PLANES/g,t.numClippingPlanes-t.numClipIntersection)}var _C=/^[ \t]*#include +<([\w\d./]+)>/gm;function vC(e){return e.replace(_C,yC)}function yC(e,t){let n=cx[t];if(n===void 0)throw Error(`THREE.WebGLProgram: Can not resolve #include <`+t+`>`);return vC(n)}var bC=/#pragma unroll_loop_start\s+for\s*\(\s*int\s+i\s*=\s*(\d+)\s*;\s*i\s*<\s*(\d+)\s*;\s*i\s*\+\+\s*\)\s*{([\s\S]+?)}\s+#pragma unroll_loop_end/g;function xC(e){return e.replace(bC,SC)}function SC(e,t,n,r){let i=``;for(let e=parseInt(t);e<parseInt(n);e++)i+=r.replace(/\[\s*i\s*\]/g,`[ `+e+` ]`).replace(/UNROLLED_LOOP_INDEX/g,e);return i}function CC(e){let t=`precision ${e.precision} float;
	precision ${e.precision} int;
	precision ${e.precision} sampler2D;
	precision ${e.precision} samplerCube;
	precision ${e.precision} sampler3D;
	precision ${e.precision} sampler2DArray;
	precision ${e.precision} sampler2DShadow;
	precision ${e.precision} samplerCubeShadow;
	precision ${e.precision} sampler2DArrayShadow;
	precision ${e.precision} isampler2D;
	precision ${e.precision} isampler3D;
	precision ${e.precision} isamplerCube;
	precision ${e.precision} isampler2DArray;
	precision ${e.precision} usampler2D;
	precision ${e.precision} usampler3D;
	precision ${e.precision} usamplerCube;
	precision ${e.precision} usampler2DArray;
	`;return e.precision===`highp`?t+=`
#define HIGH_PRECISION`:e.precision===`mediump`?t+=`
#define MEDIUM_PRECISION`:e.precision===`lowp`&&(t+=`
#define LOW_PRECISION`),t}var wC={1:`SHADOWMAP_TYPE_PCF`,3:`SHADOWMAP_TYPE_VSM`};function TC(e){return wC[e.shadowMapType]||`SHADOWMAP_TYPE_BASIC`}var EC={302:`ENVMAP_MODE_REFRACTION`};function DC(e){return e.envMap===!1?`ENVMAP_MODE_REFLECTION`:EC[e.envMapMode]||`ENVMAP_MODE_REFLECTION`}var OC={0:`ENVMAP_BLENDING_MULTIPLY`,1:`ENVMAP_BLENDING_MIX`,2:`ENVMAP_BLENDING_ADD`};function kC(e){return e.envMap===!1?`ENVMAP_BLENDING_NONE`:OC[e.combine]||`ENVMAP_BLENDING_NONE`}function AC(e,t,n,r){let i=e.getContext(),a=n.defines,o=n.vertexShader,s=n.fragmentShader,c=TC(n),l=n.envMapPMREM===!0?`ENVMAP_TYPE_PMREM`:`ENVMAP_TYPE_CUBE`,u=DC(n),d=kC(n),f=dC(n),p=fC(a),m=i.createProgram(),h,g,_=n.glslVersion?`#version `+n.glslVersion+`
`:``;n.isRawShaderMaterial?(h=[`#define SHADER_TYPE `+n.shaderType,`#define SHADER_NAME `+n.shaderName,p].filter(mC).join(`
`),h.length>0&&(h+=`
`),g=[`#define SHADER_TYPE `+n.shaderType,`#define SHADER_NAME `+n.shaderName,p].filter(mC).join(`
`),g.length>0&&(g+=`
`)):(h=[CC(n),`#define SHADER_TYPE `+n.shaderType,`#define SHADER_NAME `+n.shaderName,p,n.extensionClipCullDistance?`#define USE_CLIP_DISTANCE`:``,n.batching?`#define USE_BATCHING`:``,n.batchingColor?`#define USE_BATCHING_COLOR`:``,n.instancing?`#define USE_INSTANCING`:``,n.instancingColor?`#define USE_INSTANCING_COLOR`:``,n.instancingMorph?`#define USE_INSTANCING_MORPH`:``,n.useFog&&n.fog?`#define USE_FOG`:``,n.useFog&&n.fogExp2?`#define FOG_EXP2`:``,n.map?`#define USE_MAP`:``,n.envMap?`#define USE_ENVMAP`:``,n.envMap?`#define `+u:``,n.lightMap?`#define USE_LIGHTMAP`:``,n.aoMap?`#define USE_AOMAP`:``,n.bumpMap?`#define USE_BUMPMAP`:``,n.normalMap?`#define USE_NORMALMAP`:``,n.normalMapObjectSpace?`#define USE_NORMALMAP_OBJECTSPACE`:``,n.normalMapTangentSpace?`#define USE_NORMALMAP_TANGENTSPACE`:``,n.displacementMap?`#define USE_DISPLACEMENTMAP`:``,n.emissiveMap?`#define USE_EMISSIVEMAP`:``,n.anisotropy?`#define USE_ANISOTROPY`:``,n.anisotropyMap?`#define USE_ANISOTROPYMAP`:``,n.clearcoatMap?`#define USE_CLEARCOATMAP`:``,n.clearcoatRoughnessMap?`#define USE_CLEARCOAT_ROUGHNESSMAP`:``,n.clearcoatNormalMap?`#define USE_CLEARCOAT_NORMALMAP`:``,n.diffuseRoughnessMap?`#define USE_DIFFUSE_ROUGHNESSMAP`:``,n.iridescenceMap?`#define USE_IRIDESCENCEMAP`:``,n.iridescenceThicknessMap?`#define USE_IRIDESCENCE_THICKNESSMAP`:``,n.specularMap?`#define USE_SPECULARMAP`:``,n.specularColorMap?`#define USE_SPECULAR_COLORMAP`:``,n.specularIntensityMap?`#define USE_SPECULAR_INTENSITYMAP`:``,n.roughnessMap?`#define USE_ROUGHNESSMAP`:``,n.metalnessMap?`#define USE_METALNESSMAP`:``,n.alphaMap?`#define USE_ALPHAMAP`:``,n.alphaHash?`#define USE_ALPHAHASH`:``,n.transmission?`#define USE_TRANSMISSION`:``,n.transmissionMap?`#define USE_TRANSMISSIONMAP`:``,n.thicknessMap?`#define USE_THICKNESSMAP`:``,n.sheenColorMap?`#define USE_SHEEN_COLORMAP`:``,n.sheenRoughnessMap?`#define USE_SHEEN_ROUGHNESSMAP`:``,n.mapUv?`#define MAP_UV `+n.mapUv:``,n.alphaMapUv?`#define ALPHAMAP_UV `+n.alphaMapUv:``,n.lightMapUv?`#define LIGHTMAP_UV `+n.lightMapUv:``,n.aoMapUv?`#define AOMAP_UV `+n.aoMapUv:``,n.emissiveMapUv?`#define EMISSIVEMAP_UV `+n.emissiveMapUv:``,n.bumpMapUv?`#define BUMPMAP_UV `+n.bumpMapUv:``,n.normalMapUv?`#define NORMALMAP_UV `+n.normalMapUv:``,n.displacementMapUv?`#define DISPLACEMENTMAP_UV `+n.displacementMapUv:``,n.metalnessMapUv?`#define METALNESSMAP_UV `+n.metalnessMapUv:``,n.roughnessMapUv?`#define ROUGHNESSMAP_UV `+n.roughnessMapUv:``,n.anisotropyMapUv?`#define ANISOTROPYMAP_UV `+n.anisotropyMapUv:``,n.clearcoatMapUv?`#define CLEARCOATMAP_UV `+n.clearcoatMapUv:``,n.clearcoatNormalMapUv?`#define CLEARCOAT_NORMALMAP_UV `+n.clearcoatNormalMapUv:``,n.clearcoatRoughnessMapUv?`#define CLEARCOAT_ROUGHNESSMAP_UV `+n.clearcoatRoughnessMapUv:``,n.diffuseRoughnessMapUv?`#define DIFFUSE_ROUGHNESSMAP_UV `+n.diffuseRoughnessMapUv:``,n.iridescenceMapUv?`#define IRIDESCENCEMAP_UV `+n.iridescenceMapUv:``,n.iridescenceThicknessMapUv?`#define IRIDESCENCE_THICKNESSMAP_UV `+n.iridescenceThicknessMapUv:``,n.sheenColorMapUv?`#define SHEEN_COLORMAP_UV `+n.sheenColorMapUv:``,n.sheenRoughnessMapUv?`#define SHEEN_ROUGHNESSMAP_UV `+n.sheenRoughnessMapUv:``,n.specularMapUv?`#define SPECULARMAP_UV `+n.specularMapUv:``,n.specularColorMapUv?`#define SPECULAR_COLORMAP_UV `+n.specularColorMapUv:``,n.specularIntensityMapUv?`#define SPECULAR_INTENSITYMAP_UV `+n.specularIntensityMapUv:``,n.transmissionMapUv?`#define TRANSMISSIONMAP_UV `+n.transmissionMapUv:``,n.thicknessMapUv?`#define THICKNESSMAP_UV `+n.thicknessMapUv:``,n.vertexTangents&&n.flatShading===!1?`#define USE_TANGENT`:``,n.vertexNormals?`#define HAS_NORMAL`:``,n.vertexColors?`#define USE_COLOR`:``,n.vertexAlphas?`#define USE_COLOR_ALPHA`:``,n.vertexUv1s?`#define USE_UV1`:``,n.vertexUv2s?`#define USE_UV2`:``,n.vertexUv3s?`#define USE_UV3`:``,n.pointsUvs?`#define USE_POINTS_UV`:``,n.flatShading?`#define FLAT_SHADED`:``,n.skinning?`#define USE_SKINNING`:``,n.morphTargets?`#define USE_MORPHTARGETS`:``,n.morphNormals&&n.flatShading===!1?`#define USE_MORPHNORMALS`:``,n.morphColors?`#define USE_MORPHCOLORS`:``,n.morphTargetsCount>0?`#define MORPHTARGETS_TEXTURE_STRIDE `+n.morphTextureStride:``,n.morphTargetsCount>0?`#define MORPHTARGETS_COUNT `+n.morphTargetsCount:``,n.doubleSided?`#define DOUBLE_SIDED`:``,n.flipSided?`#define FLIP_SIDED`:``,n.shadowMapEnabled?`#define USE_SHADOWMAP`:``,n.shadowMapEnabled?`#define `+c:``,n.sizeAttenuation?`#define USE_SIZEATTENUATION`:``,n.numLightProbes>0?`#define USE_LIGHT_PROBES`:``,n.logarithmicDepthBuffer?`#define USE_LOGARITHMIC_DEPTH_BUFFER`:``,n.reversedDepthBuffer?`#define USE_REVERSED_DEPTH_BUFFER`:``,`uniform mat4 modelMatrix;`,`uniform mat4 modelViewMatrix;`,`uniform mat4 projectionMatrix;`,`uniform mat4 viewMatrix;`,`uniform mat3 normalMatrix;`,`uniform vec3 cameraPosition;`,`uniform bool isOrthographic;`,`#ifdef USE_INSTANCING`,`	attribute mat4 instanceMatrix;`,`#endif`,`#ifdef USE_INSTANCING_COLOR`,`	attribute vec3 instanceColor;`,`#endif`,`#ifdef USE_INSTANCING_MORPH`,`	uniform sampler2D morphTexture;`,`#endif`,`attribute vec3 position;`,`attribute vec3 normal;`,`attribute vec2 uv;`,`#ifdef USE_UV1`,`	attribute vec2 uv1;`,`#endif`,`#ifdef USE_UV2`,`	attribute vec2 uv2;`,`#endif`,`#ifdef USE_UV3`,`	attribute vec2 uv3;`,`#endif`,`#ifdef USE_TANGENT`,`	attribute vec4 tangent;`,`#endif`,`#if defined( USE_COLOR_ALPHA )`,`	attribute vec4 color;`,`#elif defined( USE_COLOR )`,`	attribute vec3 color;`,`#endif`,`#ifdef USE_SKINNING`,`	attribute vec4 skinIndex;`,`	attribute vec4 skinWeight;`,`#endif`,`
`].filter(mC).join(`
`),g=[CC(n),`#define SHADER_TYPE `+n.shaderType,`#define SHADER_NAME `+n.shaderName,p,n.useFog&&n.fog?`#define USE_FOG`:``,n.useFog&&n.fogExp2?`#define FOG_EXP2`:``,n.alphaToCoverage?`#define ALPHA_TO_COVERAGE`:``,n.map?`#define USE_MAP`:``,n.matcap?`#define USE_MATCAP`:``,n.envMap?`#define USE_ENVMAP`:``,n.envMap?`#define `+l:``,n.envMap?`#define `+u:``,n.envMap?`#define `+d:``,n.envMapPMREM?`#define ENVMAP_MAX_LOD `+n.envMapMaxLod+`.0`:``,n.envMapPMREM?`#define ENVMAP_SIZE `+n.envMapSize+`.0`:``,n.lightMap?`#define USE_LIGHTMAP`:``,n.aoMap?`#define USE_AOMAP`:``,n.bumpMap?`#define USE_BUMPMAP`:``,n.normalMap?`#define USE_NORMALMAP`:``,n.normalMapObjectSpace?`#define USE_NORMALMAP_OBJECTSPACE`:``,n.normalMapTangentSpace?`#define USE_NORMALMAP_TANGENTSPACE`:``,n.packedNormalMap?`#define USE_PACKED_NORMALMAP`:``,n.emissiveMap?`#define USE_EMISSIVEMAP`:``,n.anisotropy?`#define USE_ANISOTROPY`:``,n.anisotropyMap?`#define USE_ANISOTROPYMAP`:``,n.clearcoat?`#define USE_CLEARCOAT`:``,n.clearcoatMap?`#define USE_CLEARCOATMAP`:``,n.clearcoatRoughnessMap?`#define USE_CLEARCOAT_ROUGHNESSMAP`:``,n.clearcoatNormalMap?`#define USE_CLEARCOAT_NORMALMAP`:``,n.diffuseRoughness?`#define USE_DIFFUSE_ROUGHNESS`:``,n.diffuseRoughnessMap?`#define USE_DIFFUSE_ROUGHNESSMAP`:``,n.dispersion?`#define USE_DISPERSION`:``,n.retroreflection?`#define USE_RETROREFLECTION`:``,n.iridescence?`#define USE_IRIDESCENCE`:``,n.iridescenceMap?`#define USE_IRIDESCENCEMAP`:``,n.iridescenceThicknessMap?`#define USE_IRIDESCENCE_THICKNESSMAP`:``,n.specularMap?`#define USE_SPECULARMAP`:``,n.specularColorMap?`#define USE_SPECULAR_COLORMAP`:``,n.specularIntensityMap?`#define USE_SPECULAR_INTENSITYMAP`:``,n.roughnessMap?`#define USE_ROUGHNESSMAP`:``,n.metalnessMap?`#define USE_METALNESSMAP`:``,n.alphaMap?`#define USE_ALPHAMAP`:``,n.alphaTest?`#define USE_ALPHATEST`:``,n.alphaHash?`#define USE_ALPHAHASH`:``,n.sheen?`#define USE_SHEEN`:``,n.sheenColorMap?`#define USE_SHEEN_COLORMAP`:``,n.sheenRoughnessMap?`#define USE_SHEEN_ROUGHNESSMAP`:``,n.transmission?`#define USE_TRANSMISSION`:``,n.transmissionMap?`#define USE_TRANSMISSIONMAP`:``,n.thicknessMap?`#define USE_THICKNESSMAP`:``,n.vertexTangents&&n.flatShading===!1?`#define USE_TANGENT`:``,n.vertexColors||n.instancingColor?`#define USE_COLOR`:``,n.vertexAlphas||n.batchingColor?`#define USE_COLOR_ALPHA`:``,n.vertexUv1s?`#define USE_UV1`:``,n.vertexUv2s?`#define USE_UV2`:``,n.vertexUv3s?`#define USE_UV3`:``,n.pointsUvs?`#define USE_POINTS_UV`:``,n.gradientMap?`#define USE_GRADIENTMAP`:``,n.flatShading?`#define FLAT_SHADED`:``,n.doubleSided?`#define DOUBLE_SIDED`:``,n.flipSided?`#define FLIP_SIDED`:``,n.shadowMapEnabled?`#define USE_SHADOWMAP`:``,n.shadowMapEnabled?`#define `+c:``,n.premultipliedAlpha?`#define PREMULTIPLIED_ALPHA`:``,n.numLightProbes>0?`#define USE_LIGHT_PROBES`:``,n.decodeVideoTexture?`#define DECODE_VIDEO_TEXTURE`:``,n.decodeVideoTextureEmissive?`#define DECODE_VIDEO_TEXTURE_EMISSIVE`:``,n.logarithmicDepthBuffer?`#define USE_LOGARITHMIC_DEPTH_BUFFER`:``,n.reversedDepthBuffer?`#define USE_REVERSED_DEPTH_BUFFER`:``,`uniform mat4 viewMatrix;`,`uniform vec3 cameraPosition;`,`uniform bool isOrthographic;`,n.toneMapping===0?``:`#define TONE_MAPPING`,n.toneMapping===0?``:cx.tonemapping_pars_fragment,n.toneMapping===0?``:cC(`toneMapping`,n.toneMapping),n.dithering?`#define DITHERING`:``,n.opaque?`#define OPAQUE`:``,cx.colorspace_pars_fragment,oC(`linearToOutputTexel`,n.outputColorSpace),uC(),n.useDepthPacking?`#define DEPTH_PACKING `+n.depthPacking:``,`
`].filter(mC).join(`
`)),o=vC(o),o=hC(o,n),o=gC(o,n),s=vC(s),s=hC(s,n),s=gC(s,n),o=xC(o),s=xC(s),n.isRawShaderMaterial!==!0&&(_=`#version 300 es
`,h=[f,`#define attribute in`,`#define varying out`,`#define texture2D texture`].join(`
`)+`
`+h,g=[`#define varying in`,n.glslVersion===`300 es`?``:`layout(location = 0) out highp vec4 pc_fragColor;`,n.glslVersion===`300 es`?``:`#define gl_FragColor pc_fragColor`,`#define gl_FragDepthEXT gl_FragDepth`,`#define texture2D texture`,`#define textureCube texture`,`#define texture2DProj textureProj`,`#define texture2DLodEXT textureLod`,`#define texture2DProjLodEXT textureProjLod`,`#define textureCubeLodEXT textureLod`,`#define texture2DGradEXT textureGrad`,`#define texture2DProjGradEXT textureProjGrad`,`#define textureCubeGradEXT textureGrad`].join(`
`)+`
`+g);let v=_+h+o,y=_+g+s,b=$S(i,i.VERTEX_SHADER,v),x=$S(i,i.FRAGMENT_SHADER,y);i.attachShader(m,b),i.attachShader(m,x),n.index0AttributeName===void 0?n.hasPositionAttribute===!0&&i.bindAttribLocation(m,0,`position`):i.bindAttribLocation(m,0,n.index0AttributeName),i.linkProgram(m);function S(t){if(e.debug.checkShaderErrors){let n=i.getProgramInfoLog(m)||``,r=i.getShaderInfoLog(b)||``,a=i.getShaderInfoLog(x)||``,o=n.trim(),s=r.trim(),c=a.trim(),l=!0,u=!0;if(i.getProgramParameter(m,i.LINK_STATUS)===!1){if(l=!1,typeof e.debug.onShaderError==`function`)e.debug.onShaderError(i,m,b,x);else{let e=aC(i,b,`vertex`),n=aC(i,x,`fragment`);Cm(`WebGLProgram: Shader Error `+i.getError()+` - VALIDATE_STATUS `+i.getProgramParameter(m,i.VALIDATE_STATUS)+`

Material Name: `+t.name+`
Material Type: `+t.type+`

Program Info Log: `+o+`
`+e+`
`+n)}}else o===``?(s===``||c===``)&&(u=!1):Sm(`WebGLProgram: Program Info Log:`,o);u&&(t.diagnostics={runnable:l,programLog:o,vertexShader:{log:s,prefix:h},fragmentShader:{log:c,prefix:g}})}i.deleteShader(b),i.deleteShader(x),C=new QS(i,m),w=pC(i,m)}let C;this.getUniforms=function(){return C===void 0&&S(this),C};let w;this.getAttributes=function(){return w===void 0&&S(this),w};let T=n.rendererExtensionParallelShaderCompile===!1;return this.isReady=function(){return T===!1&&(T=i.getProgramParameter(m,eC)),T},this.destroy=function(){r.releaseStatesOfProgram(this),i.deleteProgram(m),this.program=void 0},this.type=n.shaderType,this.name=n.shaderName,this.id=tC++,this.cacheKey=t,this.usedTimes=1,this.program=m,this.vertexShader=b,this.fragmentShader=x,this}var jC=0,MC=class{constructor(){this.shaderCache=new Map,this.materialCache=new Map}update(e,t,n){let r=this._getShaderCacheForMaterial(e);return r.has(t)===!1&&(r.add(t),t.usedTimes++),r.has(n)===!1&&(r.add(n),n.usedTimes++),this}remove(e){let t=this.materialCache.get(e);for(let e of t)e.usedTimes--,e.usedTimes===0&&this.shaderCache.delete(e.code);return this.materialCache.delete(e),this}getVertexShaderStage(e){return this._getShaderStage(e.vertexShader)}getFragmentShaderStage(e){return this._getShaderStage(e.fragmentShader)}dispose(){this.shaderCache.clear(),this.materialCache.clear()}_getShaderCacheForMaterial(e){let t=this.materialCache,n=t.get(e);return n===void 0&&(n=new Set,t.set(e,n)),n}_getShaderStage(e){let t=this.shaderCache,n=t.get(e);return n===void 0&&(n=new NC(e),t.set(e,n)),n}},NC=class{constructor(e){this.id=jC++,this.code=e,this.usedTimes=0}};function PC(e){return e===1030||e===37490||e===36285}function FC(e,t,n,r,i,a){let o=new Lh,s=new MC,c=new Set,l=[],u=new Map,d=r.logarithmicDepthBuffer,f={MeshDepthMaterial:`depth`,MeshDistanceMaterial:`distance`,MeshNormalMaterial:`normal`,MeshBasicMaterial:`basic`,MeshLambertMaterial:`lambert`,MeshPhongMaterial:`phong`,MeshToonMaterial:`toon`,MeshStandardMaterial:`physical`,MeshPhysicalMaterial:`physical`,MeshMatcapMaterial:`matcap`,LineBasicMaterial:`basic`,LineDashedMaterial:`dashed`,PointsMaterial:`points`,ShadowMaterial:`shadow`,SpriteMaterial:`sprite`};function p(e){return c.add(e),e===0?`uv`:`uv${e}`}function m(i,o,l,u,m,h){let g=u.fog,_=m.geometry,v=i.isMeshStandardMaterial||i.isMeshLambertMaterial||i.isMeshPhongMaterial?u.environment:null,y=i.isMeshStandardMaterial||i.isMeshLambertMaterial&&!i.envMap||i.isMeshPhongMaterial&&!i.envMap,b=t.get(i.envMap||v,y),x=f[i.type],S=r.precision;i.precision!==null&&(S=r.getMaxPrecision(i.precision),S!==i.precision&&Sm(`WebGLProgram.getParameters:`,i.precision,`not supported, using`,S,`instead.`));let C=_.morphAttributes.position||_.morphAttributes.normal||_.morphAttributes.color,w=C===void 0?0:C.length,T=0;_.morphAttributes.position!==void 0&&(T=1),_.morphAttributes.normal!==void 0&&(T=2),_.morphAttributes.color!==void 0&&(T=3);let E,D,O,ee;if(x){let e=lx[x];E=e.vertexShader,D=e.fragmentShader}else{E=i.vertexShader,D=i.fragmentShader;let e=s.getVertexShaderStage(i),t=s.getFragmentShaderStage(i);s.update(i,e,t),O=e.id,ee=t.id}let k=e.getRenderTarget(),te=e.state.buffers.depth.getReversed(),ne=m.isInstancedMesh===!0,re=m.isBatchedMesh===!0,ie=!!i.map,ae=!!i.matcap,oe=!!b,se=oe&&b.isPMREMTexture===!0,ce=!!i.aoMap,le=!!i.lightMap,ue=!!i.bumpMap&&i.wireframe===!1,de=!!i.normalMap,fe=!!i.displacementMap,pe=!!i.emissiveMap,me=!!i.metalnessMap,he=!!i.roughnessMap,ge=i.anisotropy>0,_e=i.clearcoat>0,ve=i.diffuseRoughness>0,ye=i.dispersion>0,be=i.retroreflectivity>0,xe=i.iridescence>0,Se=i.sheen>0,A=i.transmission>0,Ce=ge&&!!i.anisotropyMap,we=_e&&!!i.clearcoatMap,Te=_e&&!!i.clearcoatNormalMap,Ee=_e&&!!i.clearcoatRoughnessMap,De=ve&&!!i.diffuseRoughnessMap,j=xe&&!!i.iridescenceMap,Oe=xe&&!!i.iridescenceThicknessMap,ke=Se&&!!i.sheenColorMap,Ae=Se&&!!i.sheenRoughnessMap,M=!!i.specularMap,je=!!i.specularColorMap,Me=!!i.specularIntensityMap,Ne=A&&!!i.transmissionMap,Pe=A&&!!i.thicknessMap,Fe=!!i.gradientMap,Ie=!!i.alphaMap,Le=i.alphaTest>0,Re=!!i.alphaHash,ze=!!i.extensions,Be=0;i.toneMapped&&(k===null||k.isXRRenderTarget===!0)&&(Be=e.toneMapping);let Ve=se?b.isCompressedCubeTexture?b.image[0].mipmaps:b.mipmaps:null,He={shaderID:x,shaderType:i.type,shaderName:i.name,vertexShader:E,fragmentShader:D,defines:i.defines,customVertexShaderID:O,customFragmentShaderID:ee,isRawShaderMaterial:i.isRawShaderMaterial===!0,glslVersion:i.glslVersion,precision:S,batching:re,batchingColor:re&&m._colorsTexture!==null,instancing:ne,instancingColor:ne&&m.instanceColor!==null,instancingMorph:ne&&m.morphTexture!==null,outputColorSpace:k===null?e.outputColorSpace:k.isXRRenderTarget===!0?k.texture.colorSpace:uh.workingColorSpace,alphaToCoverage:!!i.alphaToCoverage,map:ie,matcap:ae,envMap:oe,envMapMode:oe&&b.mapping,envMapPMREM:se,envMapMaxLod:se?Ve.length-1:null,envMapSize:se?Ve[0].width:null,aoMap:ce,lightMap:le,bumpMap:ue,normalMap:de,displacementMap:fe,emissiveMap:pe,normalMapObjectSpace:de&&i.normalMapType===1,normalMapTangentSpace:de&&i.normalMapType===0,packedNormalMap:de&&i.normalMapType===0&&PC(i.normalMap.format),metalnessMap:me,roughnessMap:he,anisotropy:ge,anisotropyMap:Ce,clearcoat:_e,clearcoatMap:we,clearcoatNormalMap:Te,clearcoatRoughnessMap:Ee,diffuseRoughness:ve,diffuseRoughnessMap:De,dispersion:ye,retroreflection:be,iridescence:xe,iridescenceMap:j,iridescenceThicknessMap:Oe,sheen:Se,sheenColorMap:ke,sheenRoughnessMap:Ae,specularMap:M,specularColorMap:je,specularIntensityMap:Me,transmission:A,transmissionMap:Ne,thicknessMap:Pe,gradientMap:Fe,opaque:i.transparent===!1&&i.blending===1&&i.alphaToCoverage===!1,alphaMap:Ie,alphaTest:Le,alphaHash:Re,combine:i.combine,mapUv:ie&&p(i.map.channel),aoMapUv:ce&&p(i.aoMap.channel),lightMapUv:le&&p(i.lightMap.channel),bumpMapUv:ue&&p(i.bumpMap.channel),normalMapUv:de&&p(i.normalMap.channel),displacementMapUv:fe&&p(i.displacementMap.channel),emissiveMapUv:pe&&p(i.emissiveMap.channel),metalnessMapUv:me&&p(i.metalnessMap.channel),roughnessMapUv:he&&p(i.roughnessMap.channel),anisotropyMapUv:Ce&&p(i.anisotropyMap.channel),clearcoatMapUv:we&&p(i.clearcoatMap.channel),clearcoatNormalMapUv:Te&&p(i.clearcoatNormalMap.channel),clearcoatRoughnessMapUv:Ee&&p(i.clearcoatRoughnessMap.channel),diffuseRoughnessMapUv:De&&p(i.diffuseRoughnessMap.channel),iridescenceMapUv:j&&p(i.iridescenceMap.channel),iridescenceThicknessMapUv:Oe&&p(i.iridescenceThicknessMap.channel),sheenColorMapUv:ke&&p(i.sheenColorMap.channel),sheenRoughnessMapUv:Ae&&p(i.sheenRoughnessMap.channel),specularMapUv:M&&p(i.specularMap.channel),specularColorMapUv:je&&p(i.specularColorMap.channel),specularIntensityMapUv:Me&&p(i.specularIntensityMap.channel),transmissionMapUv:Ne&&p(i.transmissionMap.channel),thicknessMapUv:Pe&&p(i.thicknessMap.channel),alphaMapUv:Ie&&p(i.alphaMap.channel),vertexTangents:!!_.attributes.tangent&&(de||ge),vertexNormals:!!_.attributes.normal,vertexColors:i.vertexColors,vertexAlphas:i.vertexColors===!0&&!!_.attributes.color&&_.attributes.color.itemSize===4,pointsUvs:m.isPoints===!0&&!!_.attributes.uv&&(ie||Ie),fog:!!g,useFog:i.fog===!0,fogExp2:!!g&&g.isFogExp2,flatShading:i.wireframe===!1&&(i.flatShading===!0||_.attributes.normal===void 0&&de===!1&&(i.isMeshLambertMaterial||i.isMeshPhongMaterial||i.isMeshStandardMaterial||i.isMeshPhysicalMaterial)),sizeAttenuation:i.sizeAttenuation===!0,logarithmicDepthBuffer:d,reversedDepthBuffer:te,skinning:m.isSkinnedMesh===!0,hasPositionAttribute:_.attributes.position!==void 0,morphTargets:_.morphAttributes.position!==void 0,morphNormals:_.morphAttributes.normal!==void 0,morphColors:_.morphAttributes.color!==void 0,morphTargetsCount:w,morphTextureStride:T,numSunLights:o.sun.length,numDirLights:o.directional.length,numPointLights:o.point.length,numSpotLights:o.spot.length,numSpotLightMaps:o.spotLightMap.length,numRectAreaLights:o.rectArea.length,numHemiLights:o.hemi.length,numSunLightShadows:o.sunShadowMap.length,numDirLightShadows:o.directionalShadowMap.length,numPointLightShadows:o.pointShadowMap.length,numSpotLightShadows:o.spotShadowMap.length,numSpotLightShadowsWithMaps:o.numSpotLightShadowsWithMaps,numLightProbes:o.numLightProbes,numLightProbeGrids:h.filter(e=>e.texture!==null).length,numClippingPlanes:a.numPlanes,numClipIntersection:a.numIntersection,dithering:i.dithering,shadowMapEnabled:e.shadowMap.enabled&&l.length>0,shadowMapType:e.shadowMap.type,toneMapping:Be,decodeVideoTexture:ie&&i.map.isVideoTexture===!0&&uh.getTransfer(i.map.colorSpace)===`srgb`,decodeVideoTextureEmissive:pe&&i.emissiveMap.isVideoTexture===!0&&uh.getTransfer(i.emissiveMap.colorSpace)===`srgb`,premultipliedAlpha:i.premultipliedAlpha,doubleSided:i.side===2,flipSided:i.side===1,useDepthPacking:i.depthPacking>=0,depthPacking:i.depthPacking||0,index0AttributeName:i.index0AttributeName,extensionClipCullDistance:ze&&i.extensions.clipCullDistance===!0&&n.has(`WEBGL_clip_cull_distance`),extensionMultiDraw:(ze&&i.extensions.multiDraw===!0||re)&&n.has(`WEBGL_multi_draw`),rendererExtensionParallelShaderCompile:n.has(`KHR_parallel_shader_compile`),customProgramCacheKey:i.customProgramCacheKey()};return He.vertexUv1s=c.has(1),He.vertexUv2s=c.has(2),He.vertexUv3s=c.has(3),c.clear(),He}function h(t){let n=[];if(t.shaderID?n.push(t.shaderID):(n.push(t.customVertexShaderID),n.push(t.customFragmentShaderID)),t.defines!==void 0)for(let e in t.defines)n.push(e),n.push(t.defines[e]);return t.isRawShaderMaterial===!1&&(g(n,t),_(n,t),n.push(e.outputColorSpace)),n.push(t.customProgramCacheKey),n.join()}function g(e,t){e.push(t.precision),e.push(t.outputColorSpace),e.push(t.envMapMode),e.push(t.envMapPMREM),e.push(t.envMapMaxLod),e.push(t.envMapSize),e.push(t.mapUv),e.push(t.alphaMapUv),e.push(t.lightMapUv),e.push(t.aoMapUv),e.push(t.bumpMapUv),e.push(t.normalMapUv),e.push(t.displacementMapUv),e.push(t.emissiveMapUv),e.push(t.metalnessMapUv),e.push(t.roughnessMapUv),e.push(t.anisotropyMapUv),e.push(t.clearcoatMapUv),e.push(t.clearcoatNormalMapUv),e.push(t.clearcoatRoughnessMapUv),e.push(t.diffuseRoughnessMapUv),e.push(t.iridescenceMapUv),e.push(t.iridescenceThicknessMapUv),e.push(t.sheenColorMapUv),e.push(t.sheenRoughnessMapUv),e.push(t.specularMapUv),e.push(t.specularColorMapUv),e.push(t.specularIntensityMapUv),e.push(t.transmissionMapUv),e.push(t.thicknessMapUv),e.push(t.combine),e.push(t.fogExp2),e.push(t.sizeAttenuation),e.push(t.morphTargetsCount),e.push(t.numSunLights),e.push(t.numDirLights),e.push(t.numPointLights),e.push(t.numSpotLights),e.push(t.numSpotLightMaps),e.push(t.numHemiLights),e.push(t.numRectAreaLights),e.push(t.numSunLightShadows),e.push(t.numDirLightShadows),e.push(t.numPointLightShadows),e.push(t.numSpotLightShadows),e.push(t.numSpotLightShadowsWithMaps),e.push(t.numLightProbes),e.push(t.numLightProbeGrids),e.push(t.shadowMapType),e.push(t.toneMapping),e.push(t.numClippingPlanes),e.push(t.numClipIntersection),e.push(t.depthPacking)}function _(e,t){o.disableAll(),t.instancing&&o.enable(0),t.instancingColor&&o.enable(1),t.instancingMorph&&o.enable(2),t.matcap&&o.enable(3),t.envMap&&o.enable(4),t.normalMapObjectSpace&&o.enable(5),t.normalMapTangentSpace&&o.enable(6),t.clearcoat&&o.enable(7),t.iridescence&&o.enable(8),t.alphaTest&&o.enable(9),t.vertexColors&&o.enable(10),t.vertexAlphas&&o.enable(11),t.vertexUv1s&&o.enable(12),t.vertexUv2s&&o.enable(13),t.vertexUv3s&&o.enable(14),t.vertexTangents&&o.enable(15),t.anisotropy&&o.enable(16),t.alphaHash&&o.enable(17),t.batching&&o.enable(18),t.dispersion&&o.enable(19),t.retroreflection&&o.enable(24),t.diffuseRoughness&&o.enable(25),t.batchingColor&&o.enable(20),t.gradientMap&&o.enable(21),t.packedNormalMap&&o.enable(22),t.vertexNormals&&o.enable(23),e.push(o.mask),o.disableAll(),t.fog&&o.enable(0),t.useFog&&o.enable(1),t.flatShading&&o.enable(2),t.logarithmicDepthBuffer&&o.enable(3),t.reversedDepthBuffer&&o.enable(4),t.skinning&&o.enable(5),t.morphTargets&&o.enable(6),t.morphNormals&&o.enable(7),t.morphColors&&o.enable(8),t.premultipliedAlpha&&o.enable(9),t.shadowMapEnabled&&o.enable(10),t.doubleSided&&o.enable(11),t.flipSided&&o.enable(12),t.useDepthPacking&&o.enable(13),t.dithering&&o.enable(14),t.transmission&&o.enable(15),t.sheen&&o.enable(16),t.opaque&&o.enable(17),t.pointsUvs&&o.enable(18),t.decodeVideoTexture&&o.enable(19),t.decodeVideoTextureEmissive&&o.enable(20),t.alphaToCoverage&&o.enable(21),t.numLightProbeGrids>0&&o.enable(22),t.hasPositionAttribute&&o.enable(23),e.push(o.mask)}function v(e){let t=f[e.type],n;if(t){let e=lx[t];n=Uy.clone(e.uniforms)}else n=e.uniforms;return n}function y(t,n){let r=u.get(n);return r===void 0?(r=new AC(e,n,t,i),l.push(r),u.set(n,r)):++r.usedTimes,r}function b(e){if(--e.usedTimes===0){let t=l.indexOf(e);l[t]=l[l.length-1],l.pop(),u.delete(e.cacheKey),e.destroy()}}function x(e){s.remove(e)}function S(){s.dispose()}return{getParameters:m,getProgramCacheKey:h,getUniforms:v,acquireProgram:y,releaseProgram:b,releaseShaderCache:x,programs:l,dispose:S}}function IC(){let e=new WeakMap;function t(t){return e.has(t)}function n(t){let n=e.get(t);return n===void 0&&(n={},e.set(t,n)),n}function r(t){e.delete(t)}function i(t,n,r){e.get(t)[n]=r}function a(){e=new WeakMap}return{has:t,get:n,remove:r,update:i,dispose:a}}function LC(e,t){return e.groupOrder===t.groupOrder?e.renderOrder===t.renderOrder?e.material.id===t.material.id?e.materialVariant===t.materialVariant?e.z===t.z?e.id-t.id:e.z-t.z:e.materialVariant-t.materialVariant:e.material.id-t.material.id:e.renderOrder-t.renderOrder:e.groupOrder-t.groupOrder}function RC(e,t){return e.groupOrder===t.groupOrder?e.renderOrder===t.renderOrder?e.z===t.z?e.id-t.id:t.z-e.z:e.renderOrder-t.renderOrder:e.groupOrder-t.groupOrder}function zC(){let e=[],t=0,n=[],r=[],i=[];function a(){t=0,n.length=0,r.length=0,i.length=0}function o(e){let t=0;return e.isInstancedMesh&&(t+=2),e.isSkinnedMesh&&(t+=1),t}function s(n,r,i,a,s,c){let l=e[t];return l===void 0?(l={id:n.id,object:n,geometry:r,material:i,materialVariant:o(n),groupOrder:a,renderOrder:n.renderOrder,z:s,group:c},e[t]=l):(l.id=n.id,l.object=n,l.geometry=r,l.material=i,l.materialVariant=o(n),l.groupOrder=a,l.renderOrder=n.renderOrder,l.z=s,l.group=c),t++,l}function c(e,t,a,o,c,l,u){u.reversedDepth===!0&&(c=-c);let d=s(e,t,a,o,c,l);a.transmission>0?r.push(d):a.transparent===!0?i.push(d):n.push(d)}function l(e,t,a,o,c,l){let u=s(e,t,a,o,c,l);a.transmission>0?r.unshift(u):a.transparent===!0?i.unshift(u):n.unshift(u)}function u(e,t){n.length>1&&n.sort(e||LC),r.length>1&&r.sort(t||RC),i.length>1&&i.sort(t||RC)}function d(){for(let n=t,r=e.length;n<r;n++){let t=e[n];if(t.id===null)break;t.id=null,t.object=null,t.geometry=null,t.material=null,t.group=null}}return{opaque:n,transmissive:r,transparent:i,init:a,push:c,unshift:l,finish:d,sort:u}}function BC(){let e=new WeakMap;function t(t,n){let r=e.get(t),i;return r===void 0?(i=new zC,e.set(t,[i])):n>=r.length?(i=new zC,r.push(i)):i=r[n],i}function n(){e=new WeakMap}return{get:t,dispose:n}}function VC(){let e={};return{get:function(t){if(e[t.id]!==void 0)return e[t.id];let n;switch(t.type){case`SunLight`:case`DirectionalLight`:n={direction:new Q,color:new sg};break;case`SpotLight`:n={position:new Q,direction:new Q,color:new sg,distance:0,coneCos:0,penumbraCos:0,decay:0};break;case`PointLight`:n={position:new Q,color:new sg,distance:0,decay:0};break;case`HemisphereLight`:n={direction:new Q,skyColor:new sg,groundColor:new sg};break;case`RectAreaLight`:n={color:new sg,position:new Q,halfWidth:new Q,halfHeight:new Q}}return e[t.id]=n,n}}}function HC(){let e={};return{get:function(t){if(e[t.id]!==void 0)return e[t.id];let n;switch(t.type){case`SunLight`:case`DirectionalLight`:n={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new Z};break;case`SpotLight`:n={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new Z};break;case`PointLight`:n={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new Z,shadowCameraNear:1,shadowCameraFar:1e3}}return e[t.id]=n,n}}}var UC=0;function WC(e,t){return(t.castShadow?2:0)-(e.castShadow?2:0)+ +!!t.map-!!e.map}function GC(e){let t=new VC,n=HC(),r={version:0,hash:{sunLength:-1,directionalLength:-1,pointLength:-1,spotLength:-1,rectAreaLength:-1,hemiLength:-1,numSunShadows:-1,numDirectionalShadows:-1,numPointShadows:-1,numSpotShadows:-1,numSpotMaps:-1,numLightProbes:-1},ambient:[0,0,0],probe:[],sun:[],sunShadow:[],sunShadowMap:[],sunShadowMatrix:[],sunShadowCascade:[],directional:[],directionalShadow:[],directionalShadowMap:[],directionalShadowMatrix:[],spot:[],spotLightMap:[],spotShadow:[],spotShadowMap:[],spotLightMatrix:[],rectArea:[],rectAreaLTC1:null,rectAreaLTC2:null,point:[],pointShadow:[],pointShadowMap:[],pointShadowMatrix:[],hemi:[],numSpotLightShadowsWithMaps:0,numLightProbes:0};for(let e=0;e<9;e++)r.probe.push(new Q);let i=new Q,a=new Eh,o=new Eh;function s(i){let a=0,o=0,s=0;for(let e=0;e<9;e++)r.probe[e].set(0,0,0);let c=0,l=0,u=0,d=0,f=0,p=0,m=0,h=0,g=0,_=0,v=0,y=0,b=0,x=0;i.sort(WC);for(let e=0,S=i.length;e<S;e++){let S=i[e],C=S.color,w=S.intensity,T=S.distance,E=null;if(S.shadow&&S.shadow.map&&(E=S.shadow.map.texture.format===1030?S.shadow.map.texture:S.shadow.map.depthTexture||S.shadow.map.texture),S.isAmbientLight)a+=C.r*w,o+=C.g*w,s+=C.b*w;else if(S.isLightProbe){for(let e=0;e<9;e++)r.probe[e].addScaledVector(S.sh.coefficients[e],w);x++}else if(S.isSunLight){let e=t.get(S);if(e.color.copy(S.color).multiplyScalar(S.intensity),S.castShadow){let e=S.shadow,t=n.get(S);t.shadowIntensity=e.intensity,t.shadowBias=e.bias,t.shadowNormalBias=e.normalBias,t.shadowRadius=e.radius,t.shadowMapSize.copy(e.mapSize).multiply(e.getFrameExtents()),r.sunShadow[l]=t,r.sunShadowMap[l]=E;let i=e.getViewportCount();for(let t=0;t<i;t++)r.sunShadowMatrix[u+t]=e.getMatrix(t),r.sunShadowCascade[u+t]=e._cascadeData[t];u+=i,l++}r.sun[c]=e,c++}else if(S.isDirectionalLight){let e=t.get(S);if(e.color.copy(S.color).multiplyScalar(S.intensity),S.castShadow){let e=S.shadow,t=n.get(S);t.shadowIntensity=e.intensity,t.shadowBias=e.bias,t.shadowNormalBias=e.normalBias,t.shadowRadius=e.radius,t.shadowMapSize=e.mapSize,r.directionalShadow[d]=t,r.directionalShadowMap[d]=E,r.directionalShadowMatrix[d]=S.shadow.matrix,g++}r.directional[d]=e,d++}else if(S.isSpotLight){let e=t.get(S);e.position.setFromMatrixPosition(S.matrixWorld),e.color.copy(C).multiplyScalar(w),e.distance=T,e.coneCos=Math.cos(S.angle),e.penumbraCos=Math.cos(S.angle*(1-S.penumbra)),e.decay=S.decay,r.spot[p]=e;let i=S.shadow;if(S.map&&(r.spotLightMap[y]=S.map,y++,i.updateMatrices(S),S.castShadow&&b++),r.spotLightMatrix[p]=i.matrix,S.castShadow){let e=n.get(S);e.shadowIntensity=i.intensity,e.shadowBias=i.bias,e.shadowNormalBias=i.normalBias,e.shadowRadius=i.radius,e.shadowMapSize=i.mapSize,r.spotShadow[p]=e,r.spotShadowMap[p]=E,v++}p++}else if(S.isRectAreaLight){let e=t.get(S);e.color.copy(C).multiplyScalar(w),e.halfWidth.set(S.width*.5,0,0),e.halfHeight.set(0,S.height*.5,0),r.rectArea[m]=e,m++}else if(S.isPointLight){let e=t.get(S);if(e.color.copy(S.color).multiplyScalar(S.intensity),e.distance=S.distance,e.decay=S.decay,S.castShadow){let e=S.shadow,t=n.get(S);t.shadowIntensity=e.intensity,t.shadowBias=e.bias,t.shadowNormalBias=e.normalBias,t.shadowRadius=e.radius,t.shadowMapSize=e.mapSize,t.shadowCameraNear=e.camera.near,t.shadowCameraFar=e.camera.far,r.pointShadow[f]=t,r.pointShadowMap[f]=E,r.pointShadowMatrix[f]=S.shadow.matrix,_++}r.point[f]=e,f++}else if(S.isHemisphereLight){let e=t.get(S);e.skyColor.copy(S.color).multiplyScalar(w),e.groundColor.copy(S.groundColor).multiplyScalar(w),r.hemi[h]=e,h++}}m>0&&(e.has(`OES_texture_float_linear`)===!0?(r.rectAreaLTC1=$.LTC_FLOAT_1,r.rectAreaLTC2=$.LTC_FLOAT_2):(r.rectAreaLTC1=$.LTC_HALF_1,r.rectAreaLTC2=$.LTC_HALF_2)),r.ambient[0]=a,r.ambient[1]=o,r.ambient[2]=s;let S=r.hash;(S.sunLength!==c||S.directionalLength!==d||S.pointLength!==f||S.spotLength!==p||S.rectAreaLength!==m||S.hemiLength!==h||S.numSunShadows!==l||S.numDirectionalShadows!==g||S.numPointShadows!==_||S.numSpotShadows!==v||S.numSpotMaps!==y||S.numLightProbes!==x)&&(r.sun.length=c,r.directional.length=d,r.spot.length=p,r.rectArea.length=m,r.point.length=f,r.hemi.length=h,r.sunShadow.length=l,r.sunShadowMap.length=l,r.sunShadowMatrix.length=u,r.sunShadowCascade.length=u,r.directionalShadow.length=g,r.directionalShadowMap.length=g,r.directionalShadowMatrix.length=g,r.pointShadow.length=_,r.pointShadowMap.length=_,r.pointShadowMatrix.length=_,r.spotShadow.length=v,r.spotShadowMap.length=v,r.spotLightMatrix.length=v+y-b,r.spotLightMap.length=y,r.numSpotLightShadowsWithMaps=b,r.numLightProbes=x,S.sunLength=c,S.directionalLength=d,S.pointLength=f,S.spotLength=p,S.rectAreaLength=m,S.hemiLength=h,S.numSunShadows=l,S.numDirectionalShadows=g,S.numPointShadows=_,S.numSpotShadows=v,S.numSpotMaps=y,S.numLightProbes=x,r.version=UC++)}function c(e,t){let n=0,s=0,c=0,l=0,u=0,d=0,f=t.matrixWorldInverse;for(let t=0,p=e.length;t<p;t++){let p=e[t];if(p.isSunLight){let e=r.sun[n];e.direction.setFromMatrixPosition(p.matrixWorld),e.direction.transformDirection(f),n++}else if(p.isDirectionalLight){let e=r.directional[s];e.direction.setFromMatrixPosition(p.matrixWorld),i.setFromMatrixPosition(p.target.matrixWorld),e.direction.sub(i),e.direction.transformDirection(f),s++}else if(p.isSpotLight){let e=r.spot[l];e.position.setFromMatrixPosition(p.matrixWorld),e.position.applyMatrix4(f),e.direction.setFromMatrixPosition(p.matrixWorld),i.setFromMatrixPosition(p.target.matrixWorld),e.direction.sub(i),e.direction.transformDirection(f),l++}else if(p.isRectAreaLight){let e=r.rectArea[u];e.position.setFromMatrixPosition(p.matrixWorld),e.position.applyMatrix4(f),o.identity(),a.copy(p.matrixWorld),a.premultiply(f),o.extractRotation(a),e.halfWidth.set(p.width*.5,0,0),e.halfHeight.set(0,p.height*.5,0),e.halfWidth.applyMatrix4(o),e.halfHeight.applyMatrix4(o),u++}else if(p.isPointLight){let e=r.point[c];e.position.setFromMatrixPosition(p.matrixWorld),e.position.applyMatrix4(f),c++}else if(p.isHemisphereLight){let e=r.hemi[d];e.direction.setFromMatrixPosition(p.matrixWorld),e.direction.transformDirection(f),d++}}}return{setup:s,setupView:c,state:r}}function KC(e){let t=new GC(e),n=[],r=[],i=[];function a(e){u.camera=e,n.length=0,r.length=0,i.length=0}function o(e){e.isLightProbeGrid?i.push(e):n.push(e)}function s(e){r.push(e)}function c(){t.setup(n),i.sort((e,t)=>e.priority-t.priority||e.id-t.id)}function l(e){t.setupView(n,e)}let u={lightsArray:n,shadowsArray:r,lightProbeGridArray:i,camera:null,lights:t,transmissionRenderTarget:{},textureUnits:0};return{init:a,state:u,setupLights:c,setupLightsView:l,pushLight:o,pushShadow:s}}function qC(e){let t=new WeakMap;function n(n,r=0){let i=t.get(n),a;return i===void 0?(a=new KC(e),t.set(n,[a])):r>=i.length?(a=new KC(e),i.push(a)):a=i[r],a}function r(){t=new WeakMap}return{get:n,dispose:r}}var JC=`void main() {
	gl_Position = vec4( position, 1.0 );
}`,YC=`uniform sampler2D shadow_pass;
uniform vec2 resolution;
uniform float radius;
void main() {
	const float samples = float( VSM_SAMPLES );
	float mean = 0.0;
	float squared_mean = 0.0;
	float uvStride = samples <= 1.0 ? 0.0 : 2.0 / ( samples - 1.0 );
	float uvStart = samples <= 1.0 ? 0.0 : - 1.0;
	for ( float i = 0.0; i < samples; i ++ ) {
		float uvOffset = uvStart + i * uvStride;
		#ifdef HORIZONTAL_PASS
			vec2 distribution = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( uvOffset, 0.0 ) * radius ) / resolution ).rg;
			mean += distribution.x;
			squared_mean += distribution.y * distribution.y + distribution.x * distribution.x;
		#else
			float depth = texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( 0.0, uvOffset ) * radius ) / resolution ).r;
			mean += depth;
			squared_mean += depth * depth;
		#endif
	}
	mean = mean / samples;
	squared_mean = squared_mean / samples;
	float std_dev = sqrt( max( 0.0, squared_mean - mean * mean ) );
	gl_FragColor = vec4( mean, std_dev, 0.0, 1.0 );
}`,XC=[new Q(1,0,0),new Q(-1,0,0),new Q(0,1,0),new Q(0,-1,0),new Q(0,0,1),new Q(0,0,-1)],ZC=[new Q(0,-1,0),new Q(0,-1,0),new Q(0,0,1),new Q(0,0,-1),new Q(0,-1,0),new Q(0,-1,0)],QC=new Eh,$C=new Q,ew=new Q;function tw(e,t,n){let r=new ev,i=new Z,a=new Z,o=new xh,s=new Yy,c=new Xy,l={},u=n.maxTextureSize,d={0:1,1:0,2:2},f=new Ky({defines:{VSM_SAMPLES:8},uniforms:{shadow_pass:{value:null},resolution:{value:new Z},radius:{value:4}},vertexShader:JC,fragmentShader:YC}),p=f.clone();p.defines.HORIZONTAL_PASS=1;let m=new r_;m.setAttribute(`position`,new Hg(new Float32Array([-1,-1,.5,3,-1,.5,-1,3,.5]),3));let h=new q_(m,f),g=this;this.enabled=!1,this.autoUpdate=!0,this.needsUpdate=!1,this.type=1;let _=this.type;this.render=function(t,n,s){if(g.enabled===!1||g.autoUpdate===!1&&g.needsUpdate===!1||t.length===0)return;this.type===2&&(Sm(`WebGLShadowMap: PCFSoftShadowMap has been removed. Using PCFShadowMap instead.`),this.type=1);let c=e.getRenderTarget(),l=e.getActiveCubeFace(),d=e.getActiveMipmapLevel(),f=e.state;f.setBlending(0),f.buffers.depth.getReversed()===!0?f.buffers.color.setClear(0,0,0,0):f.buffers.color.setClear(1,1,1,1),f.buffers.depth.setTest(!0),f.setScissorTest(!1);let p=_!==this.type;p&&n.traverse(function(e){e.material&&(Array.isArray(e.material)?e.material.forEach(e=>e.needsUpdate=!0):e.material.needsUpdate=!0)});for(let c=0,l=t.length;c<l;c++){let l=t[c],d=l.shadow;if(d===void 0){Sm(`WebGLShadowMap:`,l,`has no shadow.`);continue}if(d.autoUpdate===!1&&d.needsUpdate===!1)continue;i.copy(d.mapSize);let m=d.getFrameExtents();i.multiply(m),a.copy(d.mapSize),(i.x>u||i.y>u)&&(i.x>u&&(a.x=Math.floor(u/m.x),i.x=a.x*m.x,d.mapSize.x=a.x),i.y>u&&(a.y=Math.floor(u/m.y),i.y=a.y*m.y,d.mapSize.y=a.y));let h=e.state.buffers.depth.getReversed();if(d.camera._reversedDepth=h,d.map===null||p===!0){if(d.map!==null&&(d.map.depthTexture!==null&&(d.map.depthTexture.dispose(),d.map.depthTexture=null),d.map.dispose()),this.type===3){if(l.isPointLight){Sm(`WebGLShadowMap: VSM shadow maps are not supported for PointLights. Use PCF or BasicShadowMap instead.`);continue}d.map=new Ch(i.x,i.y,{format:hp,type:np,minFilter:Kf,magFilter:Kf,generateMipmaps:!1}),d.map.texture.name=l.name+`.shadowMap`,d.map.depthTexture=new hv(i.x,i.y,tp),d.map.depthTexture.name=l.name+`.shadowMapDepth`,d.map.depthTexture.format=dp,d.map.depthTexture.compareFunction=null,d.map.depthTexture.minFilter=Uf,d.map.depthTexture.magFilter=Uf}else l.isPointLight?(d.map=new vx(i.x),d.map.depthTexture=new gv(i.x,ep)):(d.map=new Ch(i.x,i.y),d.map.depthTexture=new hv(i.x,i.y,ep)),d.map.depthTexture.name=l.name+`.shadowMap`,d.map.depthTexture.format=dp,this.type===1?(d.map.depthTexture.compareFunction=h?518:515,d.map.depthTexture.minFilter=Kf,d.map.depthTexture.magFilter=Kf):(d.map.depthTexture.compareFunction=null,d.map.depthTexture.minFilter=Uf,d.map.depthTexture.magFilter=Uf);d.camera.updateProjectionMatrix()}d.map.isWebGLCubeRenderTarget!==!0&&(d.map.width!==i.x||d.map.height!==i.y)&&d.map.setSize(i.x,i.y);let g=d.map.isWebGLCubeRenderTarget?6:d.getViewportCount();l.isPointLight!==!0&&d.updateMatrices(l,s);let _=d.camera.layers.mask&4294967294?d.camera.layers:s.layers;for(let t=0;t<g;t++){let i=d.getCamera(t);if(l.isPointLight){let e=d.camera,n=d.matrix,r=l.distance||e.far;r!==e.far&&(e.far=r,e.updateProjectionMatrix()),$C.setFromMatrixPosition(l.matrixWorld),e.position.copy($C),ew.copy(e.position),ew.add(XC[t]),e.up.copy(ZC[t]),e.lookAt(ew),e.updateMatrixWorld(),n.makeTranslation(-$C.x,-$C.y,-$C.z),QC.multiplyMatrices(e.projectionMatrix,e.matrixWorldInverse),d._frustum.setFromProjectionMatrix(QC,e.coordinateSystem,e.reversedDepth)}if(d.map.isWebGLCubeRenderTarget)e.setRenderTarget(d.map,t),e.clear();else{t===0&&(e.setRenderTarget(d.map),e.clear());let n=d.getViewport(t);o.set(a.x*n.x,a.y*n.y,a.x*n.z,a.y*n.w),f.viewport(o)}r=d.getFrustum(t),b(n,s,i,l,_,this.type)}d.isPointLightShadow!==!0&&this.type===3&&v(d,s),d.needsUpdate=!1}_=this.type,g.needsUpdate=!1,e.setRenderTarget(c,l,d)};function v(n,r){let a=t.update(h);f.defines.VSM_SAMPLES!==n.blurSamples&&(f.defines.VSM_SAMPLES=n.blurSamples,p.defines.VSM_SAMPLES=n.blurSamples,f.needsUpdate=!0,p.needsUpdate=!0),n.mapPass===null?n.mapPass=new Ch(i.x,i.y,{format:hp,type:np}):(n.mapPass.width!==n.map.width||n.mapPass.height!==n.map.height)&&n.mapPass.setSize(n.map.width,n.map.height),f.uniforms.shadow_pass.value=n.map.depthTexture,f.uniforms.resolution.value.set(n.map.width,n.map.height),f.uniforms.radius.value=n.radius,e.setRenderTarget(n.mapPass),e.clear(),e.renderBufferDirect(r,null,a,f,h,null),p.uniforms.shadow_pass.value=n.mapPass.texture,p.uniforms.resolution.value.set(n.map.width,n.map.height),p.uniforms.radius.value=n.radius,e.setRenderTarget(n.map),e.clear(),e.renderBufferDirect(r,null,a,p,h,null)}function y(t,n,r,i){let a=null,o=r.isPointLight===!0?t.customDistanceMaterial:t.customDepthMaterial;if(o!==void 0)a=o;else if(a=r.isPointLight===!0?c:s,e.localClippingEnabled&&n.clipShadows===!0&&Array.isArray(n.clippingPlanes)&&n.clippingPlanes.length!==0||n.displacementMap&&n.displacementScale!==0||n.alphaMap&&n.alphaTest>0||n.map&&n.alphaTest>0||n.alphaToCoverage===!0){let e=a.uuid,t=n.uuid,r=l[e];r===void 0&&(r={},l[e]=r);let i=r[t];i===void 0&&(i=a.clone(),r[t]=i,n.addEventListener(`dispose`,x)),a=i}if(a.visible=n.visible,a.wireframe=n.wireframe,i===3?a.side=n.shadowSide===null?n.side:n.shadowSide:a.side=n.shadowSide===null?d[n.side]:n.shadowSide,a.alphaMap=n.alphaMap,a.alphaTest=n.alphaToCoverage===!0?.5:n.alphaTest,a.map=n.map,a.clipShadows=n.clipShadows,a.clippingPlanes=n.clippingPlanes,a.clipIntersection=n.clipIntersection,a.displacementMap=n.displacementMap,a.displacementScale=n.displacementScale,a.displacementBias=n.displacementBias,a.wireframeLinewidth=n.wireframeLinewidth,a.linewidth=n.linewidth,r.isPointLight===!0&&a.isMeshDistanceMaterial===!0){let t=e.properties.get(a);t.light=r}return a}function b(n,i,a,o,s,c){if(n.visible===!1)return;if(n.layers.test(s)&&(n.isMesh||n.isLine||n.isPoints)&&(n.castShadow||n.receiveShadow&&c===3)&&(!n.frustumCulled||n.intersectsFrustum(r))){n.modelViewMatrix.multiplyMatrices(a.matrixWorldInverse,n.matrixWorld);let r=t.update(n),s=n.material;if(Array.isArray(s)){let t=r.groups;for(let l=0,u=t.length;l<u;l++){let u=t[l],d=s[u.materialIndex];if(d&&d.visible){let t=y(n,d,o,c);n.onBeforeShadow(e,n,i,a,r,t,u),e.renderBufferDirect(a,null,r,t,n,u),n.onAfterShadow(e,n,i,a,r,t,u)}}}else if(s.visible){let t=y(n,s,o,c);n.onBeforeShadow(e,n,i,a,r,t,null),e.renderBufferDirect(a,null,r,t,n,null),n.onAfterShadow(e,n,i,a,r,t,null)}}let l=n.children;for(let e=0,t=l.length;e<t;e++)b(l[e],i,a,o,s,c)}function x(e){e.target.removeEventListener(`dispose`,x);for(let t in l){let n=l[t],r=e.target.uuid;r in n&&(n[r].dispose(),delete n[r])}}}function nw(e,t){function n(){let t=!1,n=new xh,r=null,i=new xh(0,0,0,0);return{setMask:function(n){r!==n&&!t&&(e.colorMask(n,n,n,n),r=n)},setLocked:function(e){t=e},setClear:function(t,r,a,o,s){s===!0&&(t*=o,r*=o,a*=o),n.set(t,r,a,o),i.equals(n)===!1&&(e.clearColor(t,r,a,o),i.copy(n))},reset:function(){t=!1,r=null,i.set(-1,0,0,0)}}}function r(){let n=!1,r=!1,i=null,a=null,o=null;return{setReversed:function(e){if(r!==e){let n=t.get(`EXT_clip_control`);e?n.clipControlEXT(n.LOWER_LEFT_EXT,n.ZERO_TO_ONE_EXT):n.clipControlEXT(n.LOWER_LEFT_EXT,n.NEGATIVE_ONE_TO_ONE_EXT),r=e;let i=o;o=null,this.setClear(i)}},getReversed:function(){return r},setTest:function(t){t?me(e.DEPTH_TEST):he(e.DEPTH_TEST)},setMask:function(t){i!==t&&!n&&(e.depthMask(t),i=t)},setFunc:function(t){if(r&&(t=Em[t]),a!==t){switch(t){case 0:e.depthFunc(e.NEVER);break;case 1:e.depthFunc(e.ALWAYS);break;case 2:e.depthFunc(e.LESS);break;case 3:e.depthFunc(e.LEQUAL);break;case 4:e.depthFunc(e.EQUAL);break;case 5:e.depthFunc(e.GEQUAL);break;case 6:e.depthFunc(e.GREATER);break;case 7:e.depthFunc(e.NOTEQUAL);break;default:e.depthFunc(e.LEQUAL)}a=t}},setLocked:function(e){n=e},setClear:function(t){o!==t&&(o=t,r&&(t=1-t),e.clearDepth(t))},reset:function(){n=!1,i=null,a=null,o=null,r=!1}}}function i(){let t=!1,n=null,r=null,i=null,a=null,o=null,s=null,c=null,l=null;return{setTest:function(n){t||(n?me(e.STENCIL_TEST):he(e.STENCIL_TEST))},setMask:function(r){n!==r&&!t&&(e.stencilMask(r),n=r)},setFunc:function(t,n,o){(r!==t||i!==n||a!==o)&&(e.stencilFunc(t,n,o),r=t,i=n,a=o)},setOp:function(t,n,r){(o!==t||s!==n||c!==r)&&(e.stencilOp(t,n,r),o=t,s=n,c=r)},setLocked:function(e){t=e},setClear:function(t){l!==t&&(e.clearStencil(t),l=t)},reset:function(){t=!1,n=null,r=null,i=null,a=null,o=null,s=null,c=null,l=null}}}let a=new n,o=new r,s=new i,c={},l=new WeakMap,u={},d={},f={},p=new WeakMap,m=[],h=null,g=!1,_=null,v=null,y=null,b=null,x=null,S=null,C=null,w=new sg(0,0,0),T=0,E=!1,D=null,O=null,ee=null,k=null,te=null,ne=e.getParameter(e.MAX_COMBINED_TEXTURE_IMAGE_UNITS),re=!1,ie=0,ae=e.getParameter(e.VERSION);ae.indexOf(`WebGL`)===-1?ae.indexOf(`OpenGL ES`)!==-1&&(ie=parseFloat(/^OpenGL ES (\d)/.exec(ae)[1]),re=ie>=2):(ie=parseFloat(/^WebGL (\d)/.exec(ae)[1]),re=ie>=1);let oe=null,se={},ce=e.getParameter(e.SCISSOR_BOX),le=e.getParameter(e.VIEWPORT),ue=new xh().fromArray(ce),de=new xh().fromArray(le);function fe(t,n,r,i){let a=new Uint8Array(4),o=e.createTexture();e.bindTexture(t,o),e.texParameteri(t,e.TEXTURE_MIN_FILTER,e.NEAREST),e.texParameteri(t,e.TEXTURE_MAG_FILTER,e.NEAREST);for(let o=0;o<r;o++)t===e.TEXTURE_3D||t===e.TEXTURE_2D_ARRAY?e.texImage3D(n,0,e.RGBA,1,1,i,0,e.RGBA,e.UNSIGNED_BYTE,a):e.texImage2D(n+o,0,e.RGBA,1,1,0,e.RGBA,e.UNSIGNED_BYTE,a);return o}let pe={};pe[e.TEXTURE_2D]=fe(e.TEXTURE_2D,e.TEXTURE_2D,1),pe[e.TEXTURE_CUBE_MAP]=fe(e.TEXTURE_CUBE_MAP,e.TEXTURE_CUBE_MAP_POSITIVE_X,6),pe[e.TEXTURE_2D_ARRAY]=fe(e.TEXTURE_2D_ARRAY,e.TEXTURE_2D_ARRAY,1,1),pe[e.TEXTURE_3D]=fe(e.TEXTURE_3D,e.TEXTURE_3D,1,1),a.setClear(0,0,0,1),o.setClear(1),s.setClear(0),me(e.DEPTH_TEST),o.setFunc(3),A(!1),Ce(1),me(e.CULL_FACE),xe(0);function me(t){u[t]!==!0&&(e.enable(t),u[t]=!0)}function he(t){u[t]!==!1&&(e.disable(t),u[t]=!1)}function ge(t,n){return f[t]!==n&&(e.bindFramebuffer(t,n),f[t]=n,t===e.DRAW_FRAMEBUFFER&&(f[e.FRAMEBUFFER]=n),t===e.FRAMEBUFFER&&(f[e.DRAW_FRAMEBUFFER]=n),!0)}function _e(t,n){let r=m,i=!1;if(t){r=p.get(n),r===void 0&&(r=[],p.set(n,r));let a=t.textures;if(r.length!==a.length||r[0]!==e.COLOR_ATTACHMENT0){for(let t=0,n=a.length;t<n;t++)r[t]=e.COLOR_ATTACHMENT0+t;r.length=a.length,i=!0}}else r[0]!==e.BACK&&(r[0]=e.BACK,i=!0);i&&e.drawBuffers(r)}function ve(t){return h!==t&&(e.useProgram(t),h=t,!0)}let ye={100:e.FUNC_ADD,101:e.FUNC_SUBTRACT,102:e.FUNC_REVERSE_SUBTRACT};ye[103]=e.MIN,ye[104]=e.MAX;let be={200:e.ZERO,201:e.ONE,202:e.SRC_COLOR,204:e.SRC_ALPHA,210:e.SRC_ALPHA_SATURATE,208:e.DST_COLOR,206:e.DST_ALPHA,203:e.ONE_MINUS_SRC_COLOR,205:e.ONE_MINUS_SRC_ALPHA,209:e.ONE_MINUS_DST_COLOR,207:e.ONE_MINUS_DST_ALPHA,211:e.CONSTANT_COLOR,212:e.ONE_MINUS_CONSTANT_COLOR,213:e.CONSTANT_ALPHA,214:e.ONE_MINUS_CONSTANT_ALPHA};function xe(t,n,r,i,a,o,s,c,l,u){if(t===0)g===!0&&(he(e.BLEND),g=!1);else if(g===!1&&(me(e.BLEND),g=!0),t!==5){if(t!==_||u!==E){if((v!==100||x!==100)&&(e.blendEquation(e.FUNC_ADD),v=100,x=100),u)switch(t){case 1:e.blendFuncSeparate(e.ONE,e.ONE_MINUS_SRC_ALPHA,e.ONE,e.ONE_MINUS_SRC_ALPHA);break;case 2:e.blendFunc(e.ONE,e.ONE);break;case 3:e.blendFuncSeparate(e.ZERO,e.ONE_MINUS_SRC_COLOR,e.ZERO,e.ONE);break;case 4:e.blendFuncSeparate(e.DST_COLOR,e.ONE_MINUS_SRC_ALPHA,e.ZERO,e.ONE);break;default:Cm(`WebGLState: Invalid blending: `,t)}else switch(t){case 1:e.blendFuncSeparate(e.SRC_ALPHA,e.ONE_MINUS_SRC_ALPHA,e.ONE,e.ONE_MINUS_SRC_ALPHA);break;case 2:e.blendFuncSeparate(e.SRC_ALPHA,e.ONE,e.ONE,e.ONE);break;case 3:Cm(`WebGLState: SubtractiveBlending requires material.premultipliedAlpha = true`);break;case 4:Cm(`WebGLState: MultiplyBlending requires material.premultipliedAlpha = true`);break;default:Cm(`WebGLState: Invalid blending: `,t)}y=null,b=null,S=null,C=null,w.set(0,0,0),T=0,_=t,E=u}}else a||=n,o||=r,s||=i,(n!==v||a!==x)&&(e.blendEquationSeparate(ye[n],ye[a]),v=n,x=a),(r!==y||i!==b||o!==S||s!==C)&&(e.blendFuncSeparate(be[r],be[i],be[o],be[s]),y=r,b=i,S=o,C=s),(c.equals(w)===!1||l!==T)&&(e.blendColor(c.r,c.g,c.b,l),w.copy(c),T=l),_=t,E=!1}function Se(t,n){t.side===2?he(e.CULL_FACE):me(e.CULL_FACE);let r=t.side===1;n&&(r=!r),A(r),t.blending===1&&t.transparent===!1?xe(0):xe(t.blending,t.blendEquation,t.blendSrc,t.blendDst,t.blendEquationAlpha,t.blendSrcAlpha,t.blendDstAlpha,t.blendColor,t.blendAlpha,t.premultipliedAlpha),o.setFunc(t.depthFunc),o.setTest(t.depthTest),o.setMask(t.depthWrite),a.setMask(t.colorWrite);let i=t.stencilWrite;s.setTest(i),i&&(s.setMask(t.stencilWriteMask),s.setFunc(t.stencilFunc,t.stencilRef,t.stencilFuncMask),s.setOp(t.stencilFail,t.stencilZFail,t.stencilZPass)),Te(t.polygonOffset,t.polygonOffsetFactor,t.polygonOffsetUnits),t.alphaToCoverage===!0?me(e.SAMPLE_ALPHA_TO_COVERAGE):he(e.SAMPLE_ALPHA_TO_COVERAGE)}function A(t){D!==t&&(t?e.frontFace(e.CW):e.frontFace(e.CCW),D=t)}function Ce(t){t===0?he(e.CULL_FACE):(me(e.CULL_FACE),t!==O&&(t===1?e.cullFace(e.BACK):t===2?e.cullFace(e.FRONT):e.cullFace(e.FRONT_AND_BACK))),O=t}function we(t){t!==ee&&(re&&e.lineWidth(t),ee=t)}function Te(t,n,r){t?(me(e.POLYGON_OFFSET_FILL),(k!==n||te!==r)&&(k=n,te=r,o.getReversed()&&(n=-n,r=-r),e.polygonOffset(n,r))):he(e.POLYGON_OFFSET_FILL)}function Ee(t){t?me(e.SCISSOR_TEST):he(e.SCISSOR_TEST)}function De(t){t===void 0&&(t=e.TEXTURE0+ne-1),oe!==t&&(e.activeTexture(t),oe=t)}function j(t,n,r){r===void 0&&(r=oe===null?e.TEXTURE0+ne-1:oe);let i=se[r];i===void 0&&(i={type:void 0,texture:void 0},se[r]=i),(i.type!==t||i.texture!==n)&&(oe!==r&&(e.activeTexture(r),oe=r),e.bindTexture(t,n||pe[t]),i.type=t,i.texture=n)}function Oe(){let t=se[oe];t!==void 0&&t.type!==void 0&&(e.bindTexture(t.type,null),t.type=void 0,t.texture=void 0)}function ke(){try{e.compressedTexImage2D(...arguments)}catch(e){Cm(`WebGLState:`,e)}}function Ae(){try{e.compressedTexImage3D(...arguments)}catch(e){Cm(`WebGLState:`,e)}}function M(){try{e.texSubImage2D(...arguments)}catch(e){Cm(`WebGLState:`,e)}}function je(){try{e.texSubImage3D(...arguments)}catch(e){Cm(`WebGLState:`,e)}}function Me(){try{e.compressedTexSubImage2D(...arguments)}catch(e){Cm(`WebGLState:`,e)}}function Ne(){try{e.compressedTexSubImage3D(...arguments)}catch(e){Cm(`WebGLState:`,e)}}function Pe(){try{e.texStorage2D(...arguments)}catch(e){Cm(`WebGLState:`,e)}}function Fe(){try{e.texStorage3D(...arguments)}catch(e){Cm(`WebGLState:`,e)}}function Ie(){try{e.texImage2D(...arguments)}catch(e){Cm(`WebGLState:`,e)}}function Le(){try{e.texImage3D(...arguments)}catch(e){Cm(`WebGLState:`,e)}}function Re(t){return d[t]===void 0?e.getParameter(t):d[t]}function ze(t,n){d[t]!==n&&(e.pixelStorei(t,n),d[t]=n)}function Be(t){ue.equals(t)===!1&&(e.scissor(t.x,t.y,t.z,t.w),ue.copy(t))}function Ve(t){de.equals(t)===!1&&(e.viewport(t.x,t.y,t.z,t.w),de.copy(t))}function He(t,n){let r=l.get(n);r===void 0&&(r=new WeakMap,l.set(n,r));let i=r.get(t);i===void 0&&(i=e.getUniformBlockIndex(n,t.name),e.uniformBlockBinding(n,i,i),r.set(t,i))}function Ue(t,n,r){let i=l.get(n).get(t);c[i]!==r&&(e.bindBufferBase(e.UNIFORM_BUFFER,i,r),c[i]=r)}function We(){e.disable(e.BLEND),e.disable(e.CULL_FACE),e.disable(e.DEPTH_TEST),e.disable(e.POLYGON_OFFSET_FILL),e.disable(e.SCISSOR_TEST),e.disable(e.STENCIL_TEST),e.disable(e.SAMPLE_ALPHA_TO_COVERAGE),e.blendEquation(e.FUNC_ADD),e.blendFunc(e.ONE,e.ZERO),e.blendFuncSeparate(e.ONE,e.ZERO,e.ONE,e.ZERO),e.blendColor(0,0,0,0),e.colorMask(!0,!0,!0,!0),e.clearColor(0,0,0,0),e.depthMask(!0),e.depthFunc(e.LESS),o.setReversed(!1),e.clearDepth(1),e.stencilMask(4294967295),e.stencilFunc(e.ALWAYS,0,4294967295),e.stencilOp(e.KEEP,e.KEEP,e.KEEP),e.clearStencil(0),e.cullFace(e.BACK),e.frontFace(e.CCW),e.polygonOffset(0,0),e.activeTexture(e.TEXTURE0),e.bindFramebuffer(e.FRAMEBUFFER,null),e.bindFramebuffer(e.DRAW_FRAMEBUFFER,null),e.bindFramebuffer(e.READ_FRAMEBUFFER,null),e.useProgram(null),e.lineWidth(1),e.scissor(0,0,e.canvas.width,e.canvas.height),e.viewport(0,0,e.canvas.width,e.canvas.height),e.pixelStorei(e.PACK_ALIGNMENT,4),e.pixelStorei(e.UNPACK_ALIGNMENT,4),e.pixelStorei(e.UNPACK_FLIP_Y_WEBGL,!1),e.pixelStorei(e.UNPACK_PREMULTIPLY_ALPHA_WEBGL,!1),e.pixelStorei(e.UNPACK_COLORSPACE_CONVERSION_WEBGL,e.BROWSER_DEFAULT_WEBGL),e.pixelStorei(e.PACK_ROW_LENGTH,0),e.pixelStorei(e.PACK_SKIP_PIXELS,0),e.pixelStorei(e.PACK_SKIP_ROWS,0),e.pixelStorei(e.UNPACK_ROW_LENGTH,0),e.pixelStorei(e.UNPACK_IMAGE_HEIGHT,0),e.pixelStorei(e.UNPACK_SKIP_PIXELS,0),e.pixelStorei(e.UNPACK_SKIP_ROWS,0),e.pixelStorei(e.UNPACK_SKIP_IMAGES,0),u={},d={},oe=null,se={},f={},c={},p=new WeakMap,m=[],h=null,g=!1,_=null,v=null,y=null,b=null,x=null,S=null,C=null,w=new sg(0,0,0),T=0,E=!1,D=null,O=null,ee=null,k=null,te=null,ue.set(0,0,e.canvas.width,e.canvas.height),de.set(0,0,e.canvas.width,e.canvas.height),a.reset(),o.reset(),s.reset()}return{buffers:{color:a,depth:o,stencil:s},enable:me,disable:he,bindFramebuffer:ge,drawBuffers:_e,useProgram:ve,setBlending:xe,setMaterial:Se,setFlipSided:A,setCullFace:Ce,setLineWidth:we,setPolygonOffset:Te,setScissorTest:Ee,activeTexture:De,bindTexture:j,unbindTexture:Oe,compressedTexImage2D:ke,compressedTexImage3D:Ae,texImage2D:Ie,texImage3D:Le,pixelStorei:ze,getParameter:Re,updateUBOMapping:He,uniformBlockBinding:Ue,texStorage2D:Pe,texStorage3D:Fe,texSubImage2D:M,texSubImage3D:je,compressedTexSubImage2D:Me,compressedTexSubImage3D:Ne,scissor:Be,viewport:Ve,reset:We}}function rw(e,t,n,r,i,a,o){let s=t.has(`WEBGL_multisampled_render_to_texture`)?t.get(`WEBGL_multisampled_render_to_texture`):null,c=typeof navigator>`u`?!1:/OculusBrowser/g.test(navigator.userAgent),l=new Z,u=new WeakMap,d=new Set,f,p=new WeakMap,m=new Set,h=new FinalizationRegistry(e=>m.delete(e)),g=!1;try{g=typeof OffscreenCanvas<`u`&&new OffscreenCanvas(1,1).getContext(`2d`)!==null}catch{}function _(e,t){return g?new OffscreenCanvas(e,t):_m(`canvas`)}function v(e,t,n){let r=1,i=Pe(e);if((i.width>n||i.height>n)&&(r=n/Math.max(i.width,i.height)),r<1){if(typeof HTMLImageElement<`u`&&e instanceof HTMLImageElement||typeof HTMLCanvasElement<`u`&&e instanceof HTMLCanvasElement||typeof ImageBitmap<`u`&&e instanceof ImageBitmap||typeof VideoFrame<`u`&&e instanceof VideoFrame){let n=Math.floor(r*i.width),a=Math.floor(r*i.height);f===void 0&&(f=_(n,a));let o=t?_(n,a):f;return o.width=n,o.height=a,o.getContext(`2d`).drawImage(e,0,0,n,a),Sm(`WebGLRenderer: Texture has been resized from (`+i.width+`x`+i.height+`) to (`+n+`x`+a+`).`),o}return`data`in e&&Sm(`WebGLRenderer: Image in DataTexture is too big (`+i.width+`x`+i.height+`).`),e}return e}function y(e){return e.generateMipmaps}function b(t){e.generateMipmap(t)}function x(t){return t.isWebGLCubeRenderTarget?e.TEXTURE_CUBE_MAP:t.isWebGL3DRenderTarget?e.TEXTURE_3D:t.isWebGLArrayRenderTarget||t.isCompressedArrayTexture?e.TEXTURE_2D_ARRAY:e.TEXTURE_2D}function S(n,r,i,a,o,s=!1){if(n!==null){if(e[n]!==void 0)return e[n];Sm(`WebGLRenderer: Attempt to use non-existing WebGL internal format '`+n+`'`)}let c;a&&(c=t.get(`EXT_texture_norm16`),c||Sm(`WebGLRenderer: Unable to use normalized textures without EXT_texture_norm16 extension`));let l=r;if(r===e.RED&&(i===e.FLOAT&&(l=e.R32F),i===e.HALF_FLOAT&&(l=e.R16F),i===e.UNSIGNED_BYTE&&(l=e.R8),i===e.UNSIGNED_SHORT&&c&&(l=c.R16_EXT),i===e.SHORT&&c&&(l=c.R16_SNORM_EXT)),r===e.RED_INTEGER&&(i===e.UNSIGNED_BYTE&&(l=e.R8UI),i===e.UNSIGNED_SHORT&&(l=e.R16UI),i===e.UNSIGNED_INT&&(l=e.R32UI),i===e.BYTE&&(l=e.R8I),i===e.SHORT&&(l=e.R16I),i===e.INT&&(l=e.R32I)),r===e.RG&&(i===e.FLOAT&&(l=e.RG32F),i===e.HALF_FLOAT&&(l=e.RG16F),i===e.UNSIGNED_BYTE&&(l=e.RG8),i===e.UNSIGNED_SHORT&&c&&(l=c.RG16_EXT),i===e.SHORT&&c&&(l=c.RG16_SNORM_EXT)),r===e.RG_INTEGER&&(i===e.UNSIGNED_BYTE&&(l=e.RG8UI),i===e.UNSIGNED_SHORT&&(l=e.RG16UI),i===e.UNSIGNED_INT&&(l=e.RG32UI),i===e.BYTE&&(l=e.RG8I),i===e.SHORT&&(l=e.RG16I),i===e.INT&&(l=e.RG32I)),r===e.RGB_INTEGER&&(i===e.UNSIGNED_BYTE&&(l=e.RGB8UI),i===e.UNSIGNED_SHORT&&(l=e.RGB16UI),i===e.UNSIGNED_INT&&(l=e.RGB32UI),i===e.BYTE&&(l=e.RGB8I),i===e.SHORT&&(l=e.RGB16I),i===e.INT&&(l=e.RGB32I)),r===e.RGBA_INTEGER&&(i===e.UNSIGNED_BYTE&&(l=e.RGBA8UI),i===e.UNSIGNED_SHORT&&(l=e.RGBA16UI),i===e.UNSIGNED_INT&&(l=e.RGBA32UI),i===e.BYTE&&(l=e.RGBA8I),i===e.SHORT&&(l=e.RGBA16I),i===e.INT&&(l=e.RGBA32I)),r===e.RGB&&(i===e.UNSIGNED_SHORT&&c&&(l=c.RGB16_EXT),i===e.SHORT&&c&&(l=c.RGB16_SNORM_EXT),i===e.UNSIGNED_INT_5_9_9_9_REV&&(l=e.RGB9_E5),i===e.UNSIGNED_INT_10F_11F_11F_REV&&(l=e.R11F_G11F_B10F)),r===e.RGBA){let t=s?um:uh.getTransfer(o);i===e.FLOAT&&(l=e.RGBA32F),i===e.HALF_FLOAT&&(l=e.RGBA16F),i===e.UNSIGNED_BYTE&&(l=t===`srgb`?e.SRGB8_ALPHA8:e.RGBA8),i===e.UNSIGNED_SHORT&&c&&(l=c.RGBA16_EXT),i===e.SHORT&&c&&(l=c.RGBA16_SNORM_EXT),i===e.UNSIGNED_SHORT_4_4_4_4&&(l=e.RGBA4),i===e.UNSIGNED_SHORT_5_5_5_1&&(l=e.RGB5_A1)}return(l===e.R16F||l===e.R32F||l===e.RG16F||l===e.RG32F||l===e.RGBA16F||l===e.RGBA32F)&&t.get(`EXT_color_buffer_float`),l}function C(t,n){let r;return t?n===null||n===1014||n===1020?r=e.DEPTH24_STENCIL8:n===1015?r=e.DEPTH32F_STENCIL8:n===1012&&(r=e.DEPTH24_STENCIL8,Sm(`DepthTexture: 16 bit depth attachment is not supported with stencil. Using 24-bit attachment.`)):n===null||n===1014||n===1020?r=e.DEPTH_COMPONENT24:n===1015?r=e.DEPTH_COMPONENT32F:n===1012&&(r=e.DEPTH_COMPONENT16),r}function w(e,t){return y(e)===!0||e.isFramebufferTexture&&e.minFilter!==1003&&e.minFilter!==1006?Math.log2(Math.max(t.width,t.height))+1:e.mipmaps.length>0?e.mipmaps.length:e.isCompressedTexture&&Array.isArray(e.image)?t.mipmaps.length:1}function T(e){let t=new WeakRef(e);r.get(e).__ref=t,m.add(t),h.register(e,t,t)}function E(e){let t=r.get(e).__ref;t!==void 0&&(m.delete(t),h.unregister(t))}function D(e){ee(e.target)}function O(e){k(e.target)}function ee(e){e.removeEventListener(`dispose`,D),E(e),ne(e),e.isVideoTexture&&u.delete(e),e.isHTMLTexture&&d.delete(e)}function k(e){e.removeEventListener(`dispose`,O),E(e),ie(e)}function te(){for(let e of m){let t=e.deref();t!==void 0&&(t.isRenderTarget===!0?k(t):ee(t))}m.clear(),d.clear()}function ne(e){let t=r.get(e);if(t.__webglInit===void 0)return;let n=e.source,i=p.get(n);if(i){let r=i[t.__cacheKey];r.usedTimes--,r.usedTimes===0&&re(e),Object.keys(i).length===0&&p.delete(n)}r.remove(e)}function re(t){let n=r.get(t);e.deleteTexture(n.__webglTexture);let i=t.source,a=p.get(i);delete a[n.__cacheKey],o.memory.textures--}function ie(t){let n=r.get(t);n.__depthDisposeCallback&&n.__depthDisposeCallback();let i=t.depthTexture;if(i&&i.renderTarget===t&&ee(i),t.isWebGLCubeRenderTarget)for(let t=0;t<6;t++){if(Array.isArray(n.__webglFramebuffer[t]))for(let r=0;r<n.__webglFramebuffer[t].length;r++)e.deleteFramebuffer(n.__webglFramebuffer[t][r]);else e.deleteFramebuffer(n.__webglFramebuffer[t]);n.__webglDepthbuffer&&e.deleteRenderbuffer(n.__webglDepthbuffer[t])}else{if(Array.isArray(n.__webglFramebuffer))for(let t=0;t<n.__webglFramebuffer.length;t++)e.deleteFramebuffer(n.__webglFramebuffer[t]);else e.deleteFramebuffer(n.__webglFramebuffer);if(n.__webglDepthbuffer&&e.deleteRenderbuffer(n.__webglDepthbuffer),n.__webglMultisampledFramebuffer&&e.deleteFramebuffer(n.__webglMultisampledFramebuffer),n.__webglColorRenderbuffer)for(let t=0;t<n.__webglColorRenderbuffer.length;t++)n.__webglColorRenderbuffer[t]&&e.deleteRenderbuffer(n.__webglColorRenderbuffer[t]);n.__webglDepthRenderbuffer&&e.deleteRenderbuffer(n.__webglDepthRenderbuffer)}let a=t.textures;for(let t=0,n=a.length;t<n;t++){let n=r.get(a[t]);n.__webglTexture&&(e.deleteTexture(n.__webglTexture),o.memory.textures--),r.remove(a[t])}r.remove(t)}let ae=0;function oe(){ae=0}function se(){return ae}function ce(e){ae=e}function le(){let e=ae;return e>=i.maxTextures&&Sm(`WebGLTextures: Trying to use `+(e+1)+` texture units while this GPU supports only `+i.maxTextures),ae+=1,e}function ue(e){let t=[];return t.push(e.wrapS),t.push(e.wrapT),t.push(e.wrapR||0),t.push(e.magFilter),t.push(e.minFilter),t.push(e.anisotropy),t.push(e.internalFormat),t.push(e.format),t.push(e.type),t.push(e.generateMipmaps),t.push(e.mipmapsAutoUpdate),t.push(e.premultiplyAlpha),t.push(e.flipY),t.push(e.unpackAlignment),t.push(e.colorSpace),t.join()}function de(t,i){let a=r.get(t);if(t.isVideoTexture&&Me(t),t.isRenderTargetTexture===!1&&t.isExternalTexture!==!0&&t.version>0&&a.__version!==t.version){let e=t.image;if(e===null)Sm(`WebGLRenderer: Texture marked for update but no image data found.`);else if(e.complete===!1)Sm(`WebGLRenderer: Texture marked for update but image is incomplete`);else{Se(a,t,i);return}}else t.isExternalTexture&&(a.__webglTexture=t.sourceTexture?t.sourceTexture:null);n.bindTexture(e.TEXTURE_2D,a.__webglTexture,e.TEXTURE0+i)}function fe(t,i){let a=r.get(t);t.isRenderTargetTexture===!1&&t.version>0&&a.__version!==t.version?Se(a,t,i):(t.isExternalTexture&&(a.__webglTexture=t.sourceTexture?t.sourceTexture:null),n.bindTexture(e.TEXTURE_2D_ARRAY,a.__webglTexture,e.TEXTURE0+i))}function pe(t,i){let a=r.get(t);t.isRenderTargetTexture===!1&&t.version>0&&a.__version!==t.version?Se(a,t,i):n.bindTexture(e.TEXTURE_3D,a.__webglTexture,e.TEXTURE0+i)}function me(t,i){let a=r.get(t);t.version>0&&a.__version!==t.version?A(a,t,i):n.bindTexture(e.TEXTURE_CUBE_MAP,a.__webglTexture,e.TEXTURE0+i)}let he={[Bf]:e.REPEAT,[Vf]:e.CLAMP_TO_EDGE,[Hf]:e.MIRRORED_REPEAT},ge={[Uf]:e.NEAREST,[Wf]:e.NEAREST_MIPMAP_NEAREST,[Gf]:e.NEAREST_MIPMAP_LINEAR,[Kf]:e.LINEAR,[qf]:e.LINEAR_MIPMAP_NEAREST,[Jf]:e.LINEAR_MIPMAP_LINEAR},_e={512:e.NEVER,519:e.ALWAYS,513:e.LESS,515:e.LEQUAL,514:e.EQUAL,518:e.GEQUAL,516:e.GREATER,517:e.NOTEQUAL};function ve(n,a){if(a.type===1015&&t.has(`OES_texture_float_linear`)===!1&&(a.magFilter===1006||a.magFilter===1007||a.magFilter===1005||a.magFilter===1008||a.minFilter===1006||a.minFilter===1007||a.minFilter===1005||a.minFilter===1008)&&Sm(`WebGLRenderer: Unable to use linear filtering with floating point textures. OES_texture_float_linear not supported on this device.`),e.texParameteri(n,e.TEXTURE_WRAP_S,he[a.wrapS]),e.texParameteri(n,e.TEXTURE_WRAP_T,he[a.wrapT]),(n===e.TEXTURE_3D||n===e.TEXTURE_2D_ARRAY)&&e.texParameteri(n,e.TEXTURE_WRAP_R,he[a.wrapR]),e.texParameteri(n,e.TEXTURE_MAG_FILTER,ge[a.magFilter]),e.texParameteri(n,e.TEXTURE_MIN_FILTER,ge[a.minFilter]),a.compareFunction&&(e.texParameteri(n,e.TEXTURE_COMPARE_MODE,e.COMPARE_REF_TO_TEXTURE),e.texParameteri(n,e.TEXTURE_COMPARE_FUNC,_e[a.compareFunction])),t.has(`EXT_texture_filter_anisotropic`)===!0){if(a.magFilter===1003||a.minFilter!==1005&&a.minFilter!==1008||a.type===1015&&t.has(`OES_texture_float_linear`)===!1)return;if(a.anisotropy>1||r.get(a).__currentAnisotropy){let o=t.get(`EXT_texture_filter_anisotropic`);e.texParameterf(n,o.TEXTURE_MAX_ANISOTROPY_EXT,Math.min(a.anisotropy,i.getMaxAnisotropy())),r.get(a).__currentAnisotropy=a.anisotropy}}}function ye(t,n){let r=!1;t.__webglInit===void 0&&(t.__webglInit=!0,n.addEventListener(`dispose`,D),T(n));let i=n.source,a=p.get(i);a===void 0&&(a={},p.set(i,a));let s=ue(n);if(s!==t.__cacheKey){a[s]===void 0&&(a[s]={texture:e.createTexture(),usedTimes:0},o.memory.textures++,r=!0),a[s].usedTimes++;let i=a[t.__cacheKey];i!==void 0&&(a[t.__cacheKey].usedTimes--,i.usedTimes===0&&re(n)),t.__cacheKey=s,t.__webglTexture=a[s].texture}return r}function be(e,t,n){return Math.floor(Math.floor(e/n)/t)}function xe(t,r,i,a){let o=t.updateRanges;if(o.length===0)n.texSubImage2D(e.TEXTURE_2D,0,0,0,r.width,r.height,i,a,r.data);else{o.sort((e,t)=>e.start-t.start);let s=0;for(let e=1;e<o.length;e++){let t=o[s],n=o[e],i=t.start+t.count,a=be(n.start,r.width,4),c=be(t.start,r.width,4);n.start<=i+1&&a===c&&be(n.start+n.count-1,r.width,4)===a?t.count=Math.max(t.count,n.start+n.count-t.start):(++s,o[s]=n)}o.length=s+1;let c=n.getParameter(e.UNPACK_ROW_LENGTH),l=n.getParameter(e.UNPACK_SKIP_PIXELS),u=n.getParameter(e.UNPACK_SKIP_ROWS);n.pixelStorei(e.UNPACK_ROW_LENGTH,r.width);for(let t=0,s=o.length;t<s;t++){let s=o[t],c=Math.floor(s.start/4),l=Math.ceil(s.count/4),u=c%r.width,d=Math.floor(c/r.width),f=l;n.pixelStorei(e.UNPACK_SKIP_PIXELS,u),n.pixelStorei(e.UNPACK_SKIP_ROWS,d),n.texSubImage2D(e.TEXTURE_2D,0,u,d,f,1,i,a,r.data)}t.clearUpdateRanges(),n.pixelStorei(e.UNPACK_ROW_LENGTH,c),n.pixelStorei(e.UNPACK_SKIP_PIXELS,l),n.pixelStorei(e.UNPACK_SKIP_ROWS,u)}}function Se(t,o,s){let c=e.TEXTURE_2D;(o.isDataArrayTexture||o.isCompressedArrayTexture)&&(c=e.TEXTURE_2D_ARRAY),o.isData3DTexture&&(c=e.TEXTURE_3D);let l=ye(t,o),u=o.source;n.bindTexture(c,t.__webglTexture,e.TEXTURE0+s);let f=r.get(u);if(u.version!==f.__version||l===!0){if(n.activeTexture(e.TEXTURE0+s),!(typeof ImageBitmap<`u`&&o.image instanceof ImageBitmap)){let t=uh.getPrimaries(uh.workingColorSpace),r=o.colorSpace===``?null:uh.getPrimaries(o.colorSpace),i=o.colorSpace===``||t===r?e.NONE:e.BROWSER_DEFAULT_WEBGL;n.pixelStorei(e.UNPACK_FLIP_Y_WEBGL,o.flipY),n.pixelStorei(e.UNPACK_PREMULTIPLY_ALPHA_WEBGL,o.premultiplyAlpha),n.pixelStorei(e.UNPACK_COLORSPACE_CONVERSION_WEBGL,i)}n.pixelStorei(e.UNPACK_ALIGNMENT,o.unpackAlignment);let t=v(o.image,!1,i.maxTextureSize);t=Ne(o,t);let r=a.convert(o.format,o.colorSpace),p=a.convert(o.type),m=S(o.internalFormat,r,p,o.normalized,o.colorSpace,o.isVideoTexture);ve(c,o);let h,g=o.mipmaps,_=o.isVideoTexture!==!0,x=f.__version===void 0||l===!0,T=u.dataReady,E=w(o,t);if(o.isDepthTexture)m=C(o.format===fp,o.type),x&&(_?n.texStorage2D(e.TEXTURE_2D,1,m,t.width,t.height):n.texImage2D(e.TEXTURE_2D,0,m,t.width,t.height,0,r,p,null));else if(o.isDataTexture){if(g.length>0){_&&x&&n.texStorage2D(e.TEXTURE_2D,E,m,g[0].width,g[0].height);for(let t=0,i=g.length;t<i;t++)h=g[t],_?T&&n.texSubImage2D(e.TEXTURE_2D,t,0,0,h.width,h.height,r,p,h.data):n.texImage2D(e.TEXTURE_2D,t,m,h.width,h.height,0,r,p,h.data);o.generateMipmaps=!1}else _?(x&&n.texStorage2D(e.TEXTURE_2D,E,m,t.width,t.height),T&&xe(o,t,r,p)):n.texImage2D(e.TEXTURE_2D,0,m,t.width,t.height,0,r,p,t.data)}else if(o.isCompressedTexture){if(o.isCompressedArrayTexture){_&&x&&n.texStorage3D(e.TEXTURE_2D_ARRAY,E,m,g[0].width,g[0].height,t.depth);for(let i=0,a=g.length;i<a;i++)if(h=g[i],o.format!==1023){if(r!==null){if(_){if(T){if(o.layerUpdates.size>0){let t=ix(h.width,h.height,o.format,o.type);for(let a of o.layerUpdates){let o=h.data.subarray(a*t/h.data.BYTES_PER_ELEMENT,(a+1)*t/h.data.BYTES_PER_ELEMENT);n.compressedTexSubImage3D(e.TEXTURE_2D_ARRAY,i,0,0,a,h.width,h.height,1,r,o)}}else n.compressedTexSubImage3D(e.TEXTURE_2D_ARRAY,i,0,0,0,h.width,h.height,t.depth,r,h.data)}}else n.compressedTexImage3D(e.TEXTURE_2D_ARRAY,i,m,h.width,h.height,t.depth,0,h.data,0,0)}else Sm(`WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()`)}else _?T&&n.texSubImage3D(e.TEXTURE_2D_ARRAY,i,0,0,0,h.width,h.height,t.depth,r,p,h.data):n.texImage3D(e.TEXTURE_2D_ARRAY,i,m,h.width,h.height,t.depth,0,r,p,h.data);o.layerUpdates.size>0&&o.clearLayerUpdates()}else{_&&x&&n.texStorage2D(e.TEXTURE_2D,E,m,g[0].width,g[0].height);for(let t=0,i=g.length;t<i;t++)h=g[t],o.format===1023?_?T&&n.texSubImage2D(e.TEXTURE_2D,t,0,0,h.width,h.height,r,p,h.data):n.texImage2D(e.TEXTURE_2D,t,m,h.width,h.height,0,r,p,h.data):r===null?Sm(`WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()`):_?T&&n.compressedTexSubImage2D(e.TEXTURE_2D,t,0,0,h.width,h.height,r,h.data):n.compressedTexImage2D(e.TEXTURE_2D,t,m,h.width,h.height,0,h.data)}}else if(o.isDataArrayTexture){if(_){if(x&&n.texStorage3D(e.TEXTURE_2D_ARRAY,E,m,t.width,t.height,t.depth),T){if(o.layerUpdates.size>0){let i=ix(t.width,t.height,o.format,o.type);for(let a of o.layerUpdates){let o=t.data.subarray(a*i/t.data.BYTES_PER_ELEMENT,(a+1)*i/t.data.BYTES_PER_ELEMENT);n.texSubImage3D(e.TEXTURE_2D_ARRAY,0,0,0,a,t.width,t.height,1,r,p,o)}o.clearLayerUpdates()}else n.texSubImage3D(e.TEXTURE_2D_ARRAY,0,0,0,0,t.width,t.height,t.depth,r,p,t.data)}}else n.texImage3D(e.TEXTURE_2D_ARRAY,0,m,t.width,t.height,t.depth,0,r,p,t.data)}else if(o.isData3DTexture)_?(x&&n.texStorage3D(e.TEXTURE_3D,E,m,t.width,t.height,t.depth),T&&n.texSubImage3D(e.TEXTURE_3D,0,0,0,0,t.width,t.height,t.depth,r,p,t.data)):n.texImage3D(e.TEXTURE_3D,0,m,t.width,t.height,t.depth,0,r,p,t.data);else if(o.isFramebufferTexture){if(x){if(_)n.texStorage2D(e.TEXTURE_2D,E,m,t.width,t.height);else{let i=t.width,a=t.height;for(let t=0;t<E;t++)n.texImage2D(e.TEXTURE_2D,t,m,i,a,0,r,p,null),i>>=1,a>>=1}}}else if(o.isHTMLTexture){if(`texElementImage2D`in e){let n=e.canvas;if(n.hasAttribute(`layoutsubtree`)||n.setAttribute(`layoutsubtree`,`true`),t.parentNode!==n){n.appendChild(t),d.add(o),n.onpaint=e=>{let t=e.changedElements;for(let e of d)t.includes(e.image)&&(e.needsUpdate=!0)},n.requestPaint();return}if(e.texElementImage2D.length===3)e.texElementImage2D(e.TEXTURE_2D,e.RGBA8,t);else{let n=e.RGBA,r=e.RGBA,i=e.UNSIGNED_BYTE;e.texElementImage2D(e.TEXTURE_2D,0,n,r,i,t)}e.texParameteri(e.TEXTURE_2D,e.TEXTURE_MIN_FILTER,e.LINEAR),e.texParameteri(e.TEXTURE_2D,e.TEXTURE_WRAP_S,e.CLAMP_TO_EDGE),e.texParameteri(e.TEXTURE_2D,e.TEXTURE_WRAP_T,e.CLAMP_TO_EDGE)}}else if(g.length>0){if(_&&x){let t=Pe(g[0]);n.texStorage2D(e.TEXTURE_2D,E,m,t.width,t.height)}for(let t=0,i=g.length;t<i;t++)h=g[t],_?T&&n.texSubImage2D(e.TEXTURE_2D,t,0,0,r,p,h):n.texImage2D(e.TEXTURE_2D,t,m,r,p,h);o.generateMipmaps=!1}else if(_){if(x){let r=Pe(t);n.texStorage2D(e.TEXTURE_2D,E,m,r.width,r.height)}T&&n.texSubImage2D(e.TEXTURE_2D,0,0,0,r,p,t)}else n.texImage2D(e.TEXTURE_2D,0,m,r,p,t);y(o)&&o.mipmapsAutoUpdate===!0&&b(c),f.__version=u.version,o.onUpdate&&o.onUpdate(o)}t.__version=o.version}function A(t,o,s){if(o.image.length!==6)return;let c=ye(t,o),l=o.source;n.bindTexture(e.TEXTURE_CUBE_MAP,t.__webglTexture,e.TEXTURE0+s);let u=r.get(l);if(l.version!==u.__version||c===!0){n.activeTexture(e.TEXTURE0+s);let t=uh.getPrimaries(uh.workingColorSpace),r=o.colorSpace===``?null:uh.getPrimaries(o.colorSpace),d=o.colorSpace===``||t===r?e.NONE:e.BROWSER_DEFAULT_WEBGL;n.pixelStorei(e.UNPACK_FLIP_Y_WEBGL,o.flipY),n.pixelStorei(e.UNPACK_PREMULTIPLY_ALPHA_WEBGL,o.premultiplyAlpha),n.pixelStorei(e.UNPACK_ALIGNMENT,o.unpackAlignment),n.pixelStorei(e.UNPACK_COLORSPACE_CONVERSION_WEBGL,d);let f=o.isCompressedTexture||o.image[0].isCompressedTexture,p=o.image[0]&&o.image[0].isDataTexture,m=[];for(let e=0;e<6;e++)!f&&!p?m[e]=v(o.image[e],!0,i.maxCubemapSize):m[e]=p?o.image[e].image:o.image[e],m[e]=Ne(o,m[e]);let h=m[0],g=a.convert(o.format,o.colorSpace),_=a.convert(o.type),x=S(o.internalFormat,g,_,o.normalized,o.colorSpace),T=o.isVideoTexture!==!0,E=u.__version===void 0||c===!0,D=l.dataReady,O=w(o,h);ve(e.TEXTURE_CUBE_MAP,o);let ee;if(o.isDepthTexture){if(x=C(o.format===fp,o.type),E){if(T)n.texStorage2D(e.TEXTURE_CUBE_MAP,1,x,h.width,h.height);else for(let t=0;t<6;t++)n.texImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,0,x,h.width,h.height,0,g,_,null)}}else if(f){T&&E&&n.texStorage2D(e.TEXTURE_CUBE_MAP,O,x,h.width,h.height);for(let t=0;t<6;t++){ee=m[t].mipmaps;for(let r=0;r<ee.length;r++){let i=ee[r];o.format===1023?T?D&&n.texSubImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r,0,0,i.width,i.height,g,_,i.data):n.texImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r,x,i.width,i.height,0,g,_,i.data):g===null?Sm(`WebGLRenderer: Attempt to load unsupported compressed texture format in .setTextureCube()`):T?D&&n.compressedTexSubImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r,0,0,i.width,i.height,g,i.data):n.compressedTexImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r,x,i.width,i.height,0,i.data)}}}else{if(ee=o.mipmaps,T&&E){ee.length>0&&O++;let t=Pe(m[0]);n.texStorage2D(e.TEXTURE_CUBE_MAP,O,x,t.width,t.height)}for(let t=0;t<6;t++)if(p){T?D&&n.texSubImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,0,0,0,m[t].width,m[t].height,g,_,m[t].data):n.texImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,0,x,m[t].width,m[t].height,0,g,_,m[t].data);for(let r=0;r<ee.length;r++){let i=ee[r].image[t].image;T?D&&n.texSubImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r+1,0,0,i.width,i.height,g,_,i.data):n.texImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r+1,x,i.width,i.height,0,g,_,i.data)}}else{T?D&&n.texSubImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,0,0,0,g,_,m[t]):n.texImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,0,x,g,_,m[t]);for(let r=0;r<ee.length;r++){let i=ee[r];T?D&&n.texSubImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r+1,0,0,g,_,i.image[t]):n.texImage2D(e.TEXTURE_CUBE_MAP_POSITIVE_X+t,r+1,x,g,_,i.image[t])}}}y(o)&&o.mipmapsAutoUpdate===!0&&b(e.TEXTURE_CUBE_MAP),u.__version=l.version,o.onUpdate&&o.onUpdate(o)}t.__version=o.version}function Ce(t,i,o,c,l,u){let d=a.convert(o.format,o.colorSpace),f=a.convert(o.type),p=S(o.internalFormat,d,f,o.normalized,o.colorSpace),m=r.get(i),h=r.get(o);if(h.__renderTarget=i,!m.__hasExternalTextures){let t=Math.max(1,i.width>>u),r=Math.max(1,i.height>>u);l===e.TEXTURE_3D||l===e.TEXTURE_2D_ARRAY?n.texImage3D(l,u,p,t,r,i.depth,0,d,f,null):n.texImage2D(l,u,p,t,r,0,d,f,null)}n.bindFramebuffer(e.FRAMEBUFFER,t),je(i)?s.framebufferTexture2DMultisampleEXT(e.FRAMEBUFFER,c,l,h.__webglTexture,0,M(i)):(l===e.TEXTURE_2D||l>=e.TEXTURE_CUBE_MAP_POSITIVE_X&&l<=e.TEXTURE_CUBE_MAP_NEGATIVE_Z)&&e.framebufferTexture2D(e.FRAMEBUFFER,c,l,h.__webglTexture,u),n.bindFramebuffer(e.FRAMEBUFFER,null)}function we(t,n,r){if(e.bindRenderbuffer(e.RENDERBUFFER,t),n.depthBuffer){let i=n.depthTexture,a=i&&i.isDepthTexture?i.type:null,o=C(n.stencilBuffer,a),c=n.stencilBuffer?e.DEPTH_STENCIL_ATTACHMENT:e.DEPTH_ATTACHMENT;je(n)?s.renderbufferStorageMultisampleEXT(e.RENDERBUFFER,M(n),o,n.width,n.height):r?e.renderbufferStorageMultisample(e.RENDERBUFFER,M(n),o,n.width,n.height):e.renderbufferStorage(e.RENDERBUFFER,o,n.width,n.height),e.framebufferRenderbuffer(e.FRAMEBUFFER,c,e.RENDERBUFFER,t)}else{let t=n.textures;for(let i=0;i<t.length;i++){let o=t[i],c=a.convert(o.format,o.colorSpace),l=a.convert(o.type),u=S(o.internalFormat,c,l,o.normalized,o.colorSpace);je(n)?s.renderbufferStorageMultisampleEXT(e.RENDERBUFFER,M(n),u,n.width,n.height):r?e.renderbufferStorageMultisample(e.RENDERBUFFER,M(n),u,n.width,n.height):e.renderbufferStorage(e.RENDERBUFFER,u,n.width,n.height)}}e.bindRenderbuffer(e.RENDERBUFFER,null)}function Te(t,i,a){let o=i.isWebGLCubeRenderTarget===!0;if(n.bindFramebuffer(e.FRAMEBUFFER,t),!(i.depthTexture&&i.depthTexture.isDepthTexture))throw Error(`THREE.WebGLTextures: renderTarget.depthTexture must be an instance of THREE.DepthTexture.`);let c=r.get(i.depthTexture);c.__renderTarget=i;let l=o?i.depthTexture.image[0]:i.depthTexture.image;c.__webglTexture&&l.width===i.width&&l.height===i.height||(l.width=i.width,l.height=i.height,i.depthTexture.needsUpdate=!0),o?me(i.depthTexture,0):de(i.depthTexture,0);let u=c.__webglTexture,d=M(i),f=o?e.TEXTURE_CUBE_MAP_POSITIVE_X+a:e.TEXTURE_2D,p=i.depthTexture.format===1027?e.DEPTH_STENCIL_ATTACHMENT:e.DEPTH_ATTACHMENT;if(i.depthTexture.format===1026)je(i)?s.framebufferTexture2DMultisampleEXT(e.FRAMEBUFFER,p,f,u,0,d):e.framebufferTexture2D(e.FRAMEBUFFER,p,f,u,0);else if(i.depthTexture.format===1027)je(i)?s.framebufferTexture2DMultisampleEXT(e.FRAMEBUFFER,p,f,u,0,d):e.framebufferTexture2D(e.FRAMEBUFFER,p,f,u,0);else throw Error(`THREE.WebGLTextures: Unknown depthTexture format.`)}function Ee(t){let i=r.get(t),a=t.isWebGLCubeRenderTarget===!0;if(i.__boundDepthTexture!==t.depthTexture){let e=t.depthTexture;if(i.__depthDisposeCallback&&i.__depthDisposeCallback(),e){let t=()=>{delete i.__boundDepthTexture,delete i.__depthDisposeCallback,e.removeEventListener(`dispose`,t)};e.addEventListener(`dispose`,t),i.__depthDisposeCallback=t}i.__boundDepthTexture=e}if(t.depthTexture&&!i.__autoAllocateDepthBuffer){if(a)for(let e=0;e<6;e++)Te(i.__webglFramebuffer[e],t,e);else t.texture.mipmaps.length>0?Te(i.__webglFramebuffer[0],t,0):Te(i.__webglFramebuffer,t,0)}else if(a){i.__webglDepthbuffer=[];for(let r=0;r<6;r++)if(n.bindFramebuffer(e.FRAMEBUFFER,i.__webglFramebuffer[r]),i.__webglDepthbuffer[r]===void 0)i.__webglDepthbuffer[r]=e.createRenderbuffer(),we(i.__webglDepthbuffer[r],t,!1);else{let n=t.stencilBuffer?e.DEPTH_STENCIL_ATTACHMENT:e.DEPTH_ATTACHMENT,a=i.__webglDepthbuffer[r];e.bindRenderbuffer(e.RENDERBUFFER,a),e.framebufferRenderbuffer(e.FRAMEBUFFER,n,e.RENDERBUFFER,a)}}else if(t.texture.mipmaps.length>0?n.bindFramebuffer(e.FRAMEBUFFER,i.__webglFramebuffer[0]):n.bindFramebuffer(e.FRAMEBUFFER,i.__webglFramebuffer),i.__webglDepthbuffer===void 0)i.__webglDepthbuffer=e.createRenderbuffer(),we(i.__webglDepthbuffer,t,!1);else{let n=t.stencilBuffer?e.DEPTH_STENCIL_ATTACHMENT:e.DEPTH_ATTACHMENT,r=i.__webglDepthbuffer;e.bindRenderbuffer(e.RENDERBUFFER,r),e.framebufferRenderbuffer(e.FRAMEBUFFER,n,e.RENDERBUFFER,r)}n.bindFramebuffer(e.FRAMEBUFFER,null)}function De(t,n,i){let a=r.get(t);n!==void 0&&Ce(a.__webglFramebuffer,t,t.texture,e.COLOR_ATTACHMENT0,e.TEXTURE_2D,0),i!==void 0&&Ee(t)}function j(t){let i=t.texture,s=r.get(t),c=r.get(i);t.addEventListener(`dispose`,O),T(t);let l=t.textures,u=t.isWebGLCubeRenderTarget===!0,d=l.length>1;if(d||(c.__webglTexture===void 0&&(c.__webglTexture=e.createTexture()),c.__version=i.version,o.memory.textures++),u){s.__webglFramebuffer=[];for(let t=0;t<6;t++)if(i.mipmaps.length>0){s.__webglFramebuffer[t]=[];for(let n=0;n<i.mipmaps.length;n++)s.__webglFramebuffer[t][n]=e.createFramebuffer()}else s.__webglFramebuffer[t]=e.createFramebuffer()}else{if(i.mipmaps.length>0){s.__webglFramebuffer=[];for(let t=0;t<i.mipmaps.length;t++)s.__webglFramebuffer[t]=e.createFramebuffer()}else s.__webglFramebuffer=e.createFramebuffer();if(d)for(let t=0,n=l.length;t<n;t++){let n=r.get(l[t]);n.__webglTexture===void 0&&(n.__webglTexture=e.createTexture(),o.memory.textures++)}if(t.samples>0&&je(t)===!1){s.__webglMultisampledFramebuffer=e.createFramebuffer(),s.__webglColorRenderbuffer=[],n.bindFramebuffer(e.FRAMEBUFFER,s.__webglMultisampledFramebuffer);for(let n=0;n<l.length;n++){let r=l[n];s.__webglColorRenderbuffer[n]=e.createRenderbuffer(),e.bindRenderbuffer(e.RENDERBUFFER,s.__webglColorRenderbuffer[n]);let i=a.convert(r.format,r.colorSpace),o=a.convert(r.type),c=S(r.internalFormat,i,o,r.normalized,r.colorSpace,t.isXRRenderTarget===!0),u=M(t);e.renderbufferStorageMultisample(e.RENDERBUFFER,u,c,t.width,t.height),e.framebufferRenderbuffer(e.FRAMEBUFFER,e.COLOR_ATTACHMENT0+n,e.RENDERBUFFER,s.__webglColorRenderbuffer[n])}e.bindRenderbuffer(e.RENDERBUFFER,null),t.depthBuffer&&(s.__webglDepthRenderbuffer=e.createRenderbuffer(),we(s.__webglDepthRenderbuffer,t,!0)),n.bindFramebuffer(e.FRAMEBUFFER,null)}}if(u){n.bindTexture(e.TEXTURE_CUBE_MAP,c.__webglTexture),ve(e.TEXTURE_CUBE_MAP,i);for(let n=0;n<6;n++)if(i.mipmaps.length>0)for(let r=0;r<i.mipmaps.length;r++)Ce(s.__webglFramebuffer[n][r],t,i,e.COLOR_ATTACHMENT0,e.TEXTURE_CUBE_MAP_POSITIVE_X+n,r);else Ce(s.__webglFramebuffer[n],t,i,e.COLOR_ATTACHMENT0,e.TEXTURE_CUBE_MAP_POSITIVE_X+n,0);y(i)?b(e.TEXTURE_CUBE_MAP):i.mipmaps.length>0&&e.texParameteri(e.TEXTURE_CUBE_MAP,e.TEXTURE_MAX_LEVEL,i.mipmaps.length-1),n.unbindTexture()}else if(d){for(let i=0,a=l.length;i<a;i++){let a=l[i],o=r.get(a),c=e.TEXTURE_2D;(t.isWebGL3DRenderTarget||t.isWebGLArrayRenderTarget)&&(c=t.isWebGL3DRenderTarget?e.TEXTURE_3D:e.TEXTURE_2D_ARRAY),n.bindTexture(c,o.__webglTexture),ve(c,a),Ce(s.__webglFramebuffer,t,a,e.COLOR_ATTACHMENT0+i,c,0),y(a)&&b(c)}n.unbindTexture()}else{let r=e.TEXTURE_2D;if((t.isWebGL3DRenderTarget||t.isWebGLArrayRenderTarget)&&(r=t.isWebGL3DRenderTarget?e.TEXTURE_3D:e.TEXTURE_2D_ARRAY),n.bindTexture(r,c.__webglTexture),ve(r,i),i.mipmaps.length>0)for(let n=0;n<i.mipmaps.length;n++)Ce(s.__webglFramebuffer[n],t,i,e.COLOR_ATTACHMENT0,r,n);else Ce(s.__webglFramebuffer,t,i,e.COLOR_ATTACHMENT0,r,0);y(i)?b(r):i.mipmaps.length>0&&e.texParameteri(r,e.TEXTURE_MAX_LEVEL,i.mipmaps.length-1),n.unbindTexture()}t.depthBuffer&&Ee(t)}function Oe(e){let t=e.textures;for(let i=0,a=t.length;i<a;i++){let a=t[i];if(y(a)&&a.mipmapsAutoUpdate===!0){let t=x(e),i=r.get(a).__webglTexture;n.bindTexture(t,i),b(t),n.unbindTexture()}}}let ke=[];function Ae(t){if(t.samples>0){if(je(t)===!1){let i=t.textures,a=t.width,o=t.height,s=e.COLOR_BUFFER_BIT,l=t.stencilBuffer?e.DEPTH_STENCIL_ATTACHMENT:e.DEPTH_ATTACHMENT,u=r.get(t),d=i.length>1;if(d)for(let t=0;t<i.length;t++)n.bindFramebuffer(e.FRAMEBUFFER,u.__webglMultisampledFramebuffer),e.framebufferRenderbuffer(e.FRAMEBUFFER,e.COLOR_ATTACHMENT0+t,e.RENDERBUFFER,null),n.bindFramebuffer(e.FRAMEBUFFER,u.__webglFramebuffer),e.framebufferTexture2D(e.DRAW_FRAMEBUFFER,e.COLOR_ATTACHMENT0+t,e.TEXTURE_2D,null,0);n.bindFramebuffer(e.READ_FRAMEBUFFER,u.__webglMultisampledFramebuffer),t.texture.mipmaps.length>0?n.bindFramebuffer(e.DRAW_FRAMEBUFFER,u.__webglFramebuffer[0]):n.bindFramebuffer(e.DRAW_FRAMEBUFFER,u.__webglFramebuffer);for(let n=0;n<i.length;n++){if(t.resolveDepthBuffer&&(t.depthBuffer&&(s|=e.DEPTH_BUFFER_BIT),t.stencilBuffer&&t.resolveStencilBuffer&&(s|=e.STENCIL_BUFFER_BIT)),d){e.framebufferRenderbuffer(e.READ_FRAMEBUFFER,e.COLOR_ATTACHMENT0,e.RENDERBUFFER,u.__webglColorRenderbuffer[n]);let t=r.get(i[n]).__webglTexture;e.framebufferTexture2D(e.DRAW_FRAMEBUFFER,e.COLOR_ATTACHMENT0,e.TEXTURE_2D,t,0)}e.blitFramebuffer(0,0,a,o,0,0,a,o,s,e.NEAREST),c===!0&&(ke.length=0,ke.push(e.COLOR_ATTACHMENT0+n),t.depthBuffer&&t.storeMultisampledDepthBuffer===!1&&ke.push(l),e.invalidateFramebuffer(e.READ_FRAMEBUFFER,ke))}if(n.bindFramebuffer(e.READ_FRAMEBUFFER,null),n.bindFramebuffer(e.DRAW_FRAMEBUFFER,null),d)for(let t=0;t<i.length;t++){n.bindFramebuffer(e.FRAMEBUFFER,u.__webglMultisampledFramebuffer),e.framebufferRenderbuffer(e.FRAMEBUFFER,e.COLOR_ATTACHMENT0+t,e.RENDERBUFFER,u.__webglColorRenderbuffer[t]);let a=r.get(i[t]).__webglTexture;n.bindFramebuffer(e.FRAMEBUFFER,u.__webglFramebuffer),e.framebufferTexture2D(e.DRAW_FRAMEBUFFER,e.COLOR_ATTACHMENT0+t,e.TEXTURE_2D,a,0)}n.bindFramebuffer(e.DRAW_FRAMEBUFFER,u.__webglMultisampledFramebuffer)}else if(t.depthBuffer&&t.storeMultisampledDepthBuffer===!1&&c){let n=t.stencilBuffer?e.DEPTH_STENCIL_ATTACHMENT:e.DEPTH_ATTACHMENT;e.invalidateFramebuffer(e.DRAW_FRAMEBUFFER,[n])}}}function M(e){return Math.min(i.maxSamples,e.samples)}function je(e){let n=r.get(e);return e.samples>0&&t.has(`WEBGL_multisampled_render_to_texture`)===!0&&n.__useRenderToTexture!==!1}function Me(e){let t=o.render.frame;u.get(e)!==t&&(u.set(e,t),e.update())}function Ne(e,t){let n=e.colorSpace,r=e.format,i=e.type;return e.isCompressedTexture===!0||e.isVideoTexture===!0||n!==`srgb-linear`&&n!==``&&(uh.getTransfer(n)===`srgb`?(r!==1023||i!==1009)&&Sm(`WebGLTextures: sRGB encoded textures have to use RGBAFormat and UnsignedByteType.`):Cm(`WebGLTextures: Unsupported texture color space:`,n)),t}function Pe(e){return typeof HTMLImageElement<`u`&&e instanceof HTMLImageElement?(l.width=e.naturalWidth||e.width,l.height=e.naturalHeight||e.height):typeof VideoFrame<`u`&&e instanceof VideoFrame?(l.width=e.displayWidth,l.height=e.displayHeight):(l.width=e.width,l.height=e.height),l}this.allocateTextureUnit=le,this.resetTextureUnits=oe,this.getTextureUnits=se,this.setTextureUnits=ce,this.setTexture2D=de,this.setTexture2DArray=fe,this.setTexture3D=pe,this.setTextureCube=me,this.rebindTextures=De,this.setupRenderTarget=j,this.updateRenderTargetMipmap=Oe,this.updateMultisampleRenderTarget=Ae,this.setupDepthRenderbuffer=Ee,this.setupFrameBufferTexture=Ce,this.useMultisampledRTT=je,this.dispose=te}function iw(e,t){function n(n,r=``){let i,a=uh.getTransfer(r);if(n===1009)return e.UNSIGNED_BYTE;if(n===1017)return e.UNSIGNED_SHORT_4_4_4_4;if(n===1018)return e.UNSIGNED_SHORT_5_5_5_1;if(n===35902)return e.UNSIGNED_INT_5_9_9_9_REV;if(n===35899)return e.UNSIGNED_INT_10F_11F_11F_REV;if(n===1010)return e.BYTE;if(n===1011)return e.SHORT;if(n===1012)return e.UNSIGNED_SHORT;if(n===1013)return e.INT;if(n===1014)return e.UNSIGNED_INT;if(n===1015)return e.FLOAT;if(n===1016)return e.HALF_FLOAT;if(n===1021)return e.ALPHA;if(n===1022)return e.RGB;if(n===1023)return e.RGBA;if(n===1026)return e.DEPTH_COMPONENT;if(n===1027)return e.DEPTH_STENCIL;if(n===1028)return e.RED;if(n===1029)return e.RED_INTEGER;if(n===1030)return e.RG;if(n===1031)return e.RG_INTEGER;if(n===1033)return e.RGBA_INTEGER;if(n===33776||n===33777||n===33778||n===33779){if(a===`srgb`){if(i=t.get(`WEBGL_compressed_texture_s3tc_srgb`),i!==null){if(n===33776)return i.COMPRESSED_SRGB_S3TC_DXT1_EXT;if(n===33777)return i.COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT;if(n===33778)return i.COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT;if(n===33779)return i.COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT}else return null}else if(i=t.get(`WEBGL_compressed_texture_s3tc`),i!==null){if(n===33776)return i.COMPRESSED_RGB_S3TC_DXT1_EXT;if(n===33777)return i.COMPRESSED_RGBA_S3TC_DXT1_EXT;if(n===33778)return i.COMPRESSED_RGBA_S3TC_DXT3_EXT;if(n===33779)return i.COMPRESSED_RGBA_S3TC_DXT5_EXT}else return null}if(n===35840||n===35841||n===35842||n===35843){if(i=t.get(`WEBGL_compressed_texture_pvrtc`),i!==null){if(n===35840)return i.COMPRESSED_RGB_PVRTC_4BPPV1_IMG;if(n===35841)return i.COMPRESSED_RGB_PVRTC_2BPPV1_IMG;if(n===35842)return i.COMPRESSED_RGBA_PVRTC_4BPPV1_IMG;if(n===35843)return i.COMPRESSED_RGBA_PVRTC_2BPPV1_IMG}else return null}if(n===36196||n===37492||n===37496||n===37488||n===37489||n===37490||n===37491){if(i=t.get(`WEBGL_compressed_texture_etc`),i!==null){if(n===36196||n===37492)return a===`srgb`?i.COMPRESSED_SRGB8_ETC2:i.COMPRESSED_RGB8_ETC2;if(n===37496)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ETC2_EAC:i.COMPRESSED_RGBA8_ETC2_EAC;if(n===37488)return i.COMPRESSED_R11_EAC;if(n===37489)return i.COMPRESSED_SIGNED_R11_EAC;if(n===37490)return i.COMPRESSED_RG11_EAC;if(n===37491)return i.COMPRESSED_SIGNED_RG11_EAC}else return null}if(n===37808||n===37809||n===37810||n===37811||n===37812||n===37813||n===37814||n===37815||n===37816||n===37817||n===37818||n===37819||n===37820||n===37821){if(i=t.get(`WEBGL_compressed_texture_astc`),i!==null){if(n===37808)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_4x4_KHR:i.COMPRESSED_RGBA_ASTC_4x4_KHR;if(n===37809)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_5x4_KHR:i.COMPRESSED_RGBA_ASTC_5x4_KHR;if(n===37810)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_5x5_KHR:i.COMPRESSED_RGBA_ASTC_5x5_KHR;if(n===37811)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_6x5_KHR:i.COMPRESSED_RGBA_ASTC_6x5_KHR;if(n===37812)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_6x6_KHR:i.COMPRESSED_RGBA_ASTC_6x6_KHR;if(n===37813)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_8x5_KHR:i.COMPRESSED_RGBA_ASTC_8x5_KHR;if(n===37814)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_8x6_KHR:i.COMPRESSED_RGBA_ASTC_8x6_KHR;if(n===37815)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_8x8_KHR:i.COMPRESSED_RGBA_ASTC_8x8_KHR;if(n===37816)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_10x5_KHR:i.COMPRESSED_RGBA_ASTC_10x5_KHR;if(n===37817)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_10x6_KHR:i.COMPRESSED_RGBA_ASTC_10x6_KHR;if(n===37818)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_10x8_KHR:i.COMPRESSED_RGBA_ASTC_10x8_KHR;if(n===37819)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_10x10_KHR:i.COMPRESSED_RGBA_ASTC_10x10_KHR;if(n===37820)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_12x10_KHR:i.COMPRESSED_RGBA_ASTC_12x10_KHR;if(n===37821)return a===`srgb`?i.COMPRESSED_SRGB8_ALPHA8_ASTC_12x12_KHR:i.COMPRESSED_RGBA_ASTC_12x12_KHR}else return null}if(n===36492||n===36494||n===36495){if(i=t.get(`EXT_texture_compression_bptc`),i!==null){if(n===36492)return a===`srgb`?i.COMPRESSED_SRGB_ALPHA_BPTC_UNORM_EXT:i.COMPRESSED_RGBA_BPTC_UNORM_EXT;if(n===36494)return i.COMPRESSED_RGB_BPTC_SIGNED_FLOAT_EXT;if(n===36495)return i.COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT_EXT}else return null}if(n===36283||n===36284||n===36285||n===36286){if(i=t.get(`EXT_texture_compression_rgtc`),i!==null){if(n===36283)return i.COMPRESSED_RED_RGTC1_EXT;if(n===36284)return i.COMPRESSED_SIGNED_RED_RGTC1_EXT;if(n===36285)return i.COMPRESSED_RED_GREEN_RGTC2_EXT;if(n===36286)return i.COMPRESSED_SIGNED_RED_GREEN_RGTC2_EXT}else return null}return n===1020?e.UNSIGNED_INT_24_8:e[n]===void 0?null:e[n]}return{convert:n}}var aw=`
void main() {

	gl_Position = vec4( position, 1.0 );

}`,ow=`
uniform sampler2DArray depthColor;
uniform float depthWidth;
uniform float depthHeight;

void main() {

	vec2 coord = vec2( gl_FragCoord.x / depthWidth, gl_FragCoord.y / depthHeight );

	if ( coord.x >= 1.0 ) {

		gl_FragDepth = texture( depthColor, vec3( coord.x - 1.0, coord.y, 1 ) ).r;

	} else {

		gl_FragDepth = texture( depthColor, vec3( coord.x, coord.y, 0 ) ).r;

	}

}`,sw=class{constructor(){this.texture=null,this.mesh=null,this.depthNear=0,this.depthFar=0}init(e,t){if(this.texture===null){let n=new _v(e.texture);(e.depthNear!==t.depthNear||e.depthFar!==t.depthFar)&&(this.depthNear=e.depthNear,this.depthFar=e.depthFar),this.texture=n}}getMesh(e){if(this.texture!==null&&this.mesh===null){let t=e.cameras[0].viewport,n=new Ky({vertexShader:aw,fragmentShader:ow,uniforms:{depthColor:{value:this.texture},depthWidth:{value:t.z},depthHeight:{value:t.w}}});this.mesh=new q_(new Fy(20,20),n)}return this.mesh}reset(){this.texture=null,this.mesh=null}getDepthTexture(){return this.texture}},cw=class extends Dm{constructor(e,t){super();let n=this,r=null,i=1,a=null,o=`local-floor`,s=1,c=null,l=null,u=null,d=null,f=null,p=null,m=typeof XRWebGLBinding<`u`,h=new sw,g={},_=t.getContextAttributes(),v=null,y=null,b=[],x=[],S=new Z,C=null,w=null,T=new jb;T.viewport=new xh;let E=new jb;E.viewport=new xh;let D=[T,E],O=new zb,ee=null,k=null;this.cameraAutoUpdate=!0,this.enabled=!1,this.isPresenting=!1,this.getController=function(e){let t=b[e];return t===void 0&&(t=new ng,b[e]=t),t.getTargetRaySpace()},this.getControllerGrip=function(e){let t=b[e];return t===void 0&&(t=new ng,b[e]=t),t.getGripSpace()},this.getHand=function(e){let t=b[e];return t===void 0&&(t=new ng,b[e]=t),t.getHandSpace()};function te(e){let t=x.indexOf(e.inputSource);if(t===-1)return;let n=b[t];n!==void 0&&(n.update(e.inputSource,e.frame,c||a),n.dispatchEvent({type:e.type,data:e.inputSource}))}function ne(){r.removeEventListener(`select`,te),r.removeEventListener(`selectstart`,te),r.removeEventListener(`selectend`,te),r.removeEventListener(`squeeze`,te),r.removeEventListener(`squeezestart`,te),r.removeEventListener(`squeezeend`,te),r.removeEventListener(`end`,ne),r.removeEventListener(`inputsourceschange`,re);for(let e=0;e<b.length;e++){let t=x[e];t!==null&&(x[e]=null,b[e].disconnect(t))}ee=null,k=null,h.reset();for(let e in g)delete g[e];if(e.setRenderTarget(v),f=null,d=null,u=null,r=null,y=null,ce.stop(),n.isPresenting=!1,e.setPixelRatio(C),e.setSize(S.width,S.height,!1),w!==null){let e=w.camera;e.fov=w.fov,e.zoom=w.zoom,e.updateProjectionMatrix(),w=null}n.dispatchEvent({type:`sessionend`})}this.setFramebufferScaleFactor=function(e){i=e,n.isPresenting===!0&&Sm(`WebXRManager: Cannot change framebuffer scale while presenting.`)},this.setReferenceSpaceType=function(e){o=e,n.isPresenting===!0&&Sm(`WebXRManager: Cannot change reference space type while presenting.`)},this.getReferenceSpace=function(){return c||a},this.setReferenceSpace=function(e){c=e},this.getBaseLayer=function(){return d===null?f:d},this.getBinding=function(){return u===null&&m&&(u=new XRWebGLBinding(r,t)),u},this.getFrame=function(){return p},this.getSession=function(){return r},this.setSession=async function(l){if(r=l,r!==null){if(v=e.getRenderTarget(),r.addEventListener(`select`,te),r.addEventListener(`selectstart`,te),r.addEventListener(`selectend`,te),r.addEventListener(`squeeze`,te),r.addEventListener(`squeezestart`,te),r.addEventListener(`squeezeend`,te),r.addEventListener(`end`,ne),r.addEventListener(`inputsourceschange`,re),_.xrCompatible!==!0&&await t.makeXRCompatible(),C=e.getPixelRatio(),e.getSize(S),m&&`createProjectionLayer`in XRWebGLBinding.prototype){let n=null,a=null,o=null;_.depth&&(o=_.stencil?t.DEPTH24_STENCIL8:t.DEPTH_COMPONENT24,n=_.stencil?fp:dp,a=_.stencil?ap:ep);let s={colorFormat:t.RGBA8,depthFormat:o,scaleFactor:i};u=this.getBinding(),d=u.createProjectionLayer(s),r.updateRenderState({layers:[d]}),e.setPixelRatio(1),e.setSize(d.textureWidth,d.textureHeight,!1),y=new Ch(d.textureWidth,d.textureHeight,{format:up,type:Yf,depthTexture:new hv(d.textureWidth,d.textureHeight,a,void 0,void 0,void 0,void 0,void 0,void 0,n),stencilBuffer:_.stencil,colorSpace:e.outputColorSpace,samples:_.antialias?4:0,resolveDepthBuffer:d.ignoreDepthValues===!1,resolveStencilBuffer:d.ignoreDepthValues===!1,storeMultisampledDepthBuffer:d.ignoreDepthValues===!1,storeMultisampledStencilBuffer:d.ignoreDepthValues===!1})}else{let n={antialias:_.antialias,alpha:!0,depth:_.depth,stencil:_.stencil,framebufferScaleFactor:i};f=new XRWebGLLayer(r,t,n),r.updateRenderState({baseLayer:f}),e.setPixelRatio(1),e.setSize(f.framebufferWidth,f.framebufferHeight,!1),y=new Ch(f.framebufferWidth,f.framebufferHeight,{format:up,type:Yf,colorSpace:e.outputColorSpace,stencilBuffer:_.stencil,resolveDepthBuffer:f.ignoreDepthValues===!1,resolveStencilBuffer:f.ignoreDepthValues===!1,storeMultisampledDepthBuffer:f.ignoreDepthValues===!1,storeMultisampledStencilBuffer:f.ignoreDepthValues===!1})}y.isXRRenderTarget=!0,this.setFoveation(s),c=null,a=await r.requestReferenceSpace(o),ce.setContext(r),ce.start(),n.isPresenting=!0,n.dispatchEvent({type:`sessionstart`})}},this.getEnvironmentBlendMode=function(){if(r!==null)return r.environmentBlendMode},this.getDepthTexture=function(){return h.getDepthTexture()};function re(e){for(let t=0;t<e.removed.length;t++){let n=e.removed[t],r=x.indexOf(n);r>=0&&(x[r]=null,b[r].disconnect(n))}for(let t=0;t<e.added.length;t++){let n=e.added[t],r=x.indexOf(n);if(r===-1){for(let e=0;e<b.length;e++)if(e>=x.length){x.push(n),r=e;break}else if(x[e]===null){x[e]=n,r=e;break}if(r===-1)break}let i=b[r];i&&i.connect(n)}}function ie(e,t){t===null?e.matrixWorld.copy(e.matrix):e.matrixWorld.multiplyMatrices(t.matrixWorld,e.matrix),e.matrixWorldInverse.copy(e.matrixWorld).invert()}this.updateCamera=function(e){if(r===null)return;let t=e.near,n=e.far;h.texture!==null&&(h.depthNear>0&&(t=h.depthNear),h.depthFar>0&&(n=h.depthFar)),O.near=E.near=T.near=t,O.far=E.far=T.far=n,(ee!==O.near||k!==O.far)&&(r.updateRenderState({depthNear:O.near,depthFar:O.far}),ee=O.near,k=O.far),O.layers.mask=e.layers.mask|6,T.layers.mask=O.layers.mask&-5,E.layers.mask=O.layers.mask&-3;let i=e.parent,a=O.cameras;ie(O,i);for(let e=0;e<a.length;e++)ie(a[e],i);O.projectionMatrix.copy(T.projectionMatrix),O.projectionMatrixInverse.copy(T.projectionMatrixInverse),w===null&&e.isPerspectiveCamera&&(w={camera:e,fov:e.fov,zoom:e.zoom}),ae(e,O,i)};function ae(e,t,n){n===null?e.matrix.copy(t.matrixWorld):(e.matrix.copy(n.matrixWorld),e.matrix.invert(),e.matrix.multiply(t.matrixWorld)),e.matrix.decompose(e.position,e.quaternion,e.scale),e.updateMatrixWorld(!0),e.projectionMatrix.copy(t.projectionMatrix),e.projectionMatrixInverse.copy(t.projectionMatrixInverse),e.isPerspectiveCamera&&(e.fov=jm*2*Math.atan(1/e.projectionMatrix.elements[5]),e.zoom=1)}this.getCamera=function(){return O},this.getFoveation=function(){if(d!==null||f!==null)return s},this.setFoveation=function(e){s=e,d!==null&&(d.fixedFoveation=e),f!==null&&f.fixedFoveation!==void 0&&(f.fixedFoveation=e)},this.hasDepthSensing=function(){return h.texture!==null},this.getDepthSensingMesh=function(){return h.getMesh(O)},this.getCameraTexture=function(e){return g[e]};let oe=null;function se(t,i){if(l=i.getViewerPose(c||a),p=i,l!==null){let t=l.views;f!==null&&(e.setRenderTargetFramebuffer(y,f.framebuffer),e.setRenderTarget(y));let i=!1;t.length!==O.cameras.length&&(O.cameras.length=0,i=!0);for(let n=0;n<t.length;n++){let r=t[n],a=null;if(f!==null)a=f.getViewport(r);else{let t=u.getViewSubImage(d,r);a=t.viewport,n===0&&(e.setRenderTargetTextures(y,t.colorTexture,t.depthStencilTexture),e.setRenderTarget(y))}let o=D[n];o===void 0&&(o=new jb,o.layers.enable(n),o.viewport=new xh,D[n]=o),o.matrix.fromArray(r.transform.matrix),o.matrix.decompose(o.position,o.quaternion,o.scale),o.projectionMatrix.fromArray(r.projectionMatrix),o.projectionMatrixInverse.copy(o.projectionMatrix).invert(),o.viewport.set(a.x,a.y,a.width,a.height),n===0&&(O.matrix.copy(o.matrix),O.matrix.decompose(O.position,O.quaternion,O.scale)),i===!0&&O.cameras.push(o)}let a=r.enabledFeatures;if(a&&a.includes(`depth-sensing`)&&r.depthUsage==`gpu-optimized`&&m){u=n.getBinding();let e=u.getDepthInformation(t[0]);e&&e.isValid&&e.texture&&h.init(e,r.renderState)}if(a&&a.includes(`camera-access`)&&m){e.state.unbindTexture(),u=n.getBinding();for(let e=0;e<t.length;e++){let n=t[e].camera;if(n){let e=g[n];e||(e=new _v,g[n]=e);let t=u.getCameraImage(n);e.sourceTexture=t}}}}for(let e=0;e<b.length;e++){let t=x[e],n=b[e];t!==null&&n!==void 0&&n.update(t,i,c||a)}oe&&oe(t,i),i.detectedPlanes&&n.dispatchEvent({type:`planesdetected`,data:i}),p=null}let ce=new ox;ce.setAnimationLoop(se),this.setAnimationLoop=function(e){oe=e},this.dispose=function(){}}},lw=new Eh,uw=new ah;uw.set(-1,0,0,0,1,0,0,0,1);function dw(e,t){function n(e,t){e.matrixAutoUpdate===!0&&e.updateMatrix(),t.value.copy(e.matrix)}function r(t,n){n.color.getRGB(t.fogColor.value,Hy(e)),n.isFog?(t.fogNear.value=n.near,t.fogFar.value=n.far):n.isFogExp2&&(t.fogDensity.value=n.density)}function i(e,t,n,r,i){t.isNodeMaterial?t.uniformsNeedUpdate=!1:t.isMeshBasicMaterial?a(e,t):t.isMeshLambertMaterial?(a(e,t),t.envMap&&(e.envMapIntensity.value=t.envMapIntensity)):t.isMeshToonMaterial?(a(e,t),d(e,t)):t.isMeshPhongMaterial?(a(e,t),u(e,t),t.envMap&&(e.envMapIntensity.value=t.envMapIntensity)):t.isMeshStandardMaterial?(a(e,t),f(e,t),t.isMeshPhysicalMaterial&&p(e,t,i)):t.isMeshMatcapMaterial?(a(e,t),m(e,t)):t.isMeshDepthMaterial?a(e,t):t.isMeshDistanceMaterial?(a(e,t),h(e,t)):t.isMeshNormalMaterial?a(e,t):t.isLineBasicMaterial?(o(e,t),t.isLineDashedMaterial&&s(e,t)):t.isPointsMaterial?c(e,t,n,r):t.isSpriteMaterial?l(e,t):t.isShadowMaterial?(e.color.value.copy(t.color),e.opacity.value=t.opacity):t.isShaderMaterial&&(t.uniformsNeedUpdate=!1)}function a(e,r){e.opacity.value=r.opacity,r.color&&e.diffuse.value.copy(r.color),r.emissive&&e.emissive.value.copy(r.emissive).multiplyScalar(r.emissiveIntensity),r.map&&(e.map.value=r.map,n(r.map,e.mapTransform)),r.alphaMap&&(e.alphaMap.value=r.alphaMap,n(r.alphaMap,e.alphaMapTransform)),r.bumpMap&&(e.bumpMap.value=r.bumpMap,n(r.bumpMap,e.bumpMapTransform),e.bumpScale.value=r.bumpScale,r.side===1&&(e.bumpScale.value*=-1)),r.normalMap&&(e.normalMap.value=r.normalMap,n(r.normalMap,e.normalMapTransform),e.normalScale.value.copy(r.normalScale),r.side===1&&e.normalScale.value.negate()),r.displacementMap&&(e.displacementMap.value=r.displacementMap,n(r.displacementMap,e.displacementMapTransform),e.displacementScale.value=r.displacementScale,e.displacementBias.value=r.displacementBias),r.emissiveMap&&(e.emissiveMap.value=r.emissiveMap,n(r.emissiveMap,e.emissiveMapTransform)),r.specularMap&&(e.specularMap.value=r.specularMap,n(r.specularMap,e.specularMapTransform)),r.alphaTest>0&&(e.alphaTest.value=r.alphaTest);let i=t.get(r),a=i.envMap,o=i.envMapRotation;a&&(e.envMap.value=a,e.envMapRotation.value.setFromMatrix4(lw.makeRotationFromEuler(o)).transpose(),a.isCubeTexture&&a.isRenderTargetTexture===!1&&e.envMapRotation.value.premultiply(uw),e.reflectivity.value=r.reflectivity,e.ior.value=r.ior,e.refractionRatio.value=r.refractionRatio),r.lightMap&&(e.lightMap.value=r.lightMap,e.lightMapIntensity.value=r.lightMapIntensity,n(r.lightMap,e.lightMapTransform)),r.aoMap&&(e.aoMap.value=r.aoMap,e.aoMapIntensity.value=r.aoMapIntensity,n(r.aoMap,e.aoMapTransform))}function o(e,t){e.diffuse.value.copy(t.color),e.opacity.value=t.opacity,t.map&&(e.map.value=t.map,n(t.map,e.mapTransform))}function s(e,t){e.dashSize.value=t.dashSize,e.totalSize.value=t.dashSize+t.gapSize,e.scale.value=t.scale}function c(e,t,r,i){e.diffuse.value.copy(t.color),e.opacity.value=t.opacity,e.size.value=t.size*r,e.scale.value=i*.5,t.map&&(e.map.value=t.map,n(t.map,e.uvTransform)),t.alphaMap&&(e.alphaMap.value=t.alphaMap,n(t.alphaMap,e.alphaMapTransform)),t.alphaTest>0&&(e.alphaTest.value=t.alphaTest)}function l(e,t){e.diffuse.value.copy(t.color),e.opacity.value=t.opacity,e.rotation.value=t.rotation,t.map&&(e.map.value=t.map,n(t.map,e.mapTransform)),t.alphaMap&&(e.alphaMap.value=t.alphaMap,n(t.alphaMap,e.alphaMapTransform)),t.alphaTest>0&&(e.alphaTest.value=t.alphaTest)}function u(e,t){e.specular.value.copy(t.specular),e.shininess.value=Math.max(t.shininess,1e-4)}function d(e,t){t.gradientMap&&(e.gradientMap.value=t.gradientMap)}function f(e,t){e.metalness.value=t.metalness,t.metalnessMap&&(e.metalnessMap.value=t.metalnessMap,n(t.metalnessMap,e.metalnessMapTransform)),e.roughness.value=t.roughness,t.roughnessMap&&(e.roughnessMap.value=t.roughnessMap,n(t.roughnessMap,e.roughnessMapTransform)),t.envMap&&(e.envMapIntensity.value=t.envMapIntensity)}function p(e,t,r){e.ior.value=t.ior,t.diffuseRoughness>0&&(e.diffuseRoughness.value=t.diffuseRoughness,t.diffuseRoughnessMap&&(e.diffuseRoughnessMap.value=t.diffuseRoughnessMap,n(t.diffuseRoughnessMap,e.diffuseRoughnessMapTransform))),t.sheen>0&&(e.sheenColor.value.copy(t.sheenColor).multiplyScalar(t.sheen),e.sheenRoughness.value=t.sheenRoughness,t.sheenColorMap&&(e.sheenColorMap.value=t.sheenColorMap,n(t.sheenColorMap,e.sheenColorMapTransform)),t.sheenRoughnessMap&&(e.sheenRoughnessMap.value=t.sheenRoughnessMap,n(t.sheenRoughnessMap,e.sheenRoughnessMapTransform))),t.clearcoat>0&&(e.clearcoat.value=t.clearcoat,e.clearcoatRoughness.value=t.clearcoatRoughness,t.clearcoatMap&&(e.clearcoatMap.value=t.clearcoatMap,n(t.clearcoatMap,e.clearcoatMapTransform)),t.clearcoatRoughnessMap&&(e.clearcoatRoughnessMap.value=t.clearcoatRoughnessMap,n(t.clearcoatRoughnessMap,e.clearcoatRoughnessMapTransform)),t.clearcoatNormalMap&&(e.clearcoatNormalMap.value=t.clearcoatNormalMap,n(t.clearcoatNormalMap,e.clearcoatNormalMapTransform),e.clearcoatNormalScale.value.copy(t.clearcoatNormalScale),t.side===1&&e.clearcoatNormalScale.value.negate())),t.dispersion>0&&(e.dispersion.value=t.dispersion),t.retroreflectivity>0&&(e.retroreflectivity.value=t.retroreflectivity),t.iridescence>0&&(e.iridescence.value=t.iridescence,e.iridescenceIOR.value=t.iridescenceIOR,e.iridescenceThicknessMinimum.value=t.iridescenceThicknessMinimum,e.iridescenceThicknessMaximum.value=t.iridescenceThicknessMaximum,t.iridescenceMap&&(e.iridescenceMap.value=t.iridescenceMap,n(t.iridescenceMap,e.iridescenceMapTransform)),t.iridescenceThicknessMap&&(e.iridescenceThicknessMap.value=t.iridescenceThicknessMap,n(t.iridescenceThicknessMap,e.iridescenceThicknessMapTransform))),t.transmission>0&&(e.transmission.value=t.transmission,e.transmissionSamplerMap.value=r.texture,e.transmissionSamplerSize.value.set(r.width,r.height),t.transmissionMap&&(e.transmissionMap.value=t.transmissionMap,n(t.transmissionMap,e.transmissionMapTransform)),e.thickness.value=t.thickness,t.thicknessMap&&(e.thicknessMap.value=t.thicknessMap,n(t.thicknessMap,e.thicknessMapTransform)),e.attenuationDistance.value=t.attenuationDistance,e.attenuationColor.value.copy(t.attenuationColor)),t.anisotropy>0&&(e.anisotropyVector.value.set(t.anisotropy*Math.cos(t.anisotropyRotation),t.anisotropy*Math.sin(t.anisotropyRotation)),t.anisotropyMap&&(e.anisotropyMap.value=t.anisotropyMap,n(t.anisotropyMap,e.anisotropyMapTransform))),e.specularIntensity.value=t.specularIntensity,e.specularColor.value.copy(t.specularColor),t.specularColorMap&&(e.specularColorMap.value=t.specularColorMap,n(t.specularColorMap,e.specularColorMapTransform)),t.specularIntensityMap&&(e.specularIntensityMap.value=t.specularIntensityMap,n(t.specularIntensityMap,e.specularIntensityMapTransform))}function m(e,t){t.matcap&&(e.matcap.value=t.matcap)}function h(e,n){let r=t.get(n).light;e.referencePosition.value.setFromMatrixPosition(r.matrixWorld),e.nearDistance.value=r.shadow.camera.near,e.farDistance.value=r.shadow.camera.far}return{refreshFogUniforms:r,refreshMaterialUniforms:i}}function fw(e,t,n,r){let i={},a={};function o(e,t){let n=t.program;r.uniformBlockBinding(e,n,i[e.id])}function s(e,n){let o=i[e.id];o===void 0&&(m(e),o=c(e),i[e.id]=o,e.addEventListener(`dispose`,g));let s=n.program;r.updateUBOMapping(e,s);let u=t.render.frame;a[e.id]!==u&&(l(e),a[e.id]=u)}function c(t){let n=e.createBuffer(),r=t.__size,i=t.usage;return e.bindBuffer(e.UNIFORM_BUFFER,n),e.bufferData(e.UNIFORM_BUFFER,r,i),e.bindBuffer(e.UNIFORM_BUFFER,null),n}function l(t){let n=i[t.id],r=t.uniforms,a=t.__cache;e.bindBuffer(e.UNIFORM_BUFFER,n);for(let e=0,t=r.length;e<t;e++){let t=r[e];if(Array.isArray(t))for(let n=0,r=t.length;n<r;n++)u(t[n],e,n,a);else u(t,e,0,a)}e.bindBuffer(e.UNIFORM_BUFFER,null)}function u(t,n,r,i){if(f(t,n,r,i)===!0){let n=t.__offset,r=t.value;if(Array.isArray(r)){let e=0;for(let n=0;n<r.length;n++){let i=r[n],a=h(i,!0);d(i,t.__data,e),e+=a.storage/Float32Array.BYTES_PER_ELEMENT}}else d(r,t.__data,0);e.bufferSubData(e.UNIFORM_BUFFER,n,t.__data)}}function d(e,t,n){typeof e==`number`||typeof e==`boolean`?t[n]=e:e.isMatrix3?(t[n]=e.elements[0],t[n+1]=e.elements[1],t[n+2]=e.elements[2],t[n+3]=0,t[n+4]=e.elements[3],t[n+5]=e.elements[4],t[n+6]=e.elements[5],t[n+7]=0,t[n+8]=e.elements[6],t[n+9]=e.elements[7],t[n+10]=e.elements[8],t[n+11]=0):ArrayBuffer.isView(e)?t.set(e.subarray(0,t.length-n),n):e.toArray(t,n)}function f(e,t,n,r){let i=e.value,a=t+`_`+n;if(Array.isArray(i)){r[a]===void 0&&(r[a]=[]);let e=r[a],t=!1;for(let n=0;n<i.length;n++)p(i[n],e,n)===!0&&(t=!0);return t}return p(i,r,a)}function p(e,t,n){if(t[n]===void 0)return t[n]=typeof e==`number`||typeof e==`boolean`?e:ArrayBuffer.isView(e)?e.slice():e.clone(),!0;{let r=t[n];if(typeof e==`number`||typeof e==`boolean`){if(r!==e)return t[n]=e,!0}else if(ArrayBuffer.isView(e))return!0;else if(r.equals(e)===!1)return r.copy(e),!0}return!1}function m(e){let t=e.uniforms,n=0;for(let e=0,r=t.length;e<r;e++){let r=Array.isArray(t[e])?t[e]:[t[e]];for(let i=0,a=r.length;i<a;i++){let a=r[i],o=Array.isArray(a.value)?a.value:[a.value],s=Array.isArray(t[e])||Array.isArray(a.value),c=n;for(let e=0,t=o.length;e<t;e++){let t=o[e],r=h(t,s),i=n%16,a=i%r.boundary,l=i+a;n+=a,l!==0&&16-l<r.storage&&(n+=16-l),e===0&&(c=n),n+=r.storage}a.__data=new(a.type===`int`?Int32Array:a.type===`uint`?Uint32Array:Float32Array)((n-c)/Float32Array.BYTES_PER_ELEMENT),a.__offset=c}}let r=n%16;return r>0&&(n+=16-r),e.__size=n,e.__cache={},this}function h(e,t){let n={boundary:0,storage:0};return typeof e==`number`||typeof e==`boolean`?(n.boundary=4,n.storage=4):e.isVector2?(n.boundary=8,n.storage=8):e.isVector3||e.isColor?(n.boundary=16,n.storage=12):e.isVector4?(n.boundary=16,n.storage=16):e.isMatrix3?(n.boundary=16,n.storage=48):e.isMatrix4?(n.boundary=16,n.storage=64):e.isTexture?Sm(`WebGLRenderer: Texture samplers can not be part of an uniforms group.`):ArrayBuffer.isView(e)?(n.boundary=16,n.storage=e.byteLength):Sm(`WebGLRenderer: Unsupported uniform value type.`,e),t===!0&&(n.boundary=16,n.storage=Math.ceil(n.storage/16)*16),n}function g(t){let n=t.target;n.removeEventListener(`dispose`,g),e.deleteBuffer(i[n.id]),delete i[n.id],delete a[n.id]}function _(){for(let t in i)e.deleteBuffer(i[t]);i={},a={}}return{bind:o,update:s,dispose:_}}var pw=new Uint16Array([12469,15057,12620,14925,13266,14620,13807,14376,14323,13990,14545,13625,14713,13328,14840,12882,14931,12528,14996,12233,15039,11829,15066,11525,15080,11295,15085,10976,15082,10705,15073,10495,13880,14564,13898,14542,13977,14430,14158,14124,14393,13732,14556,13410,14702,12996,14814,12596,14891,12291,14937,11834,14957,11489,14958,11194,14943,10803,14921,10506,14893,10278,14858,9960,14484,14039,14487,14025,14499,13941,14524,13740,14574,13468,14654,13106,14743,12678,14818,12344,14867,11893,14889,11509,14893,11180,14881,10751,14852,10428,14812,10128,14765,9754,14712,9466,14764,13480,14764,13475,14766,13440,14766,13347,14769,13070,14786,12713,14816,12387,14844,11957,14860,11549,14868,11215,14855,10751,14825,10403,14782,10044,14729,9651,14666,9352,14599,9029,14967,12835,14966,12831,14963,12804,14954,12723,14936,12564,14917,12347,14900,11958,14886,11569,14878,11247,14859,10765,14828,10401,14784,10011,14727,9600,14660,9289,14586,8893,14508,8533,15111,12234,15110,12234,15104,12216,15092,12156,15067,12010,15028,11776,14981,11500,14942,11205,14902,10752,14861,10393,14812,9991,14752,9570,14682,9252,14603,8808,14519,8445,14431,8145,15209,11449,15208,11451,15202,11451,15190,11438,15163,11384,15117,11274,15055,10979,14994,10648,14932,10343,14871,9936,14803,9532,14729,9218,14645,8742,14556,8381,14461,8020,14365,7603,15273,10603,15272,10607,15267,10619,15256,10631,15231,10614,15182,10535,15118,10389,15042,10167,14963,9787,14883,9447,14800,9115,14710,8665,14615,8318,14514,7911,14411,7507,14279,7198,15314,9675,15313,9683,15309,9712,15298,9759,15277,9797,15229,9773,15166,9668,15084,9487,14995,9274,14898,8910,14800,8539,14697,8234,14590,7790,14479,7409,14367,7067,14178,6621,15337,8619,15337,8631,15333,8677,15325,8769,15305,8871,15264,8940,15202,8909,15119,8775,15022,8565,14916,8328,14804,8009,14688,7614,14569,7287,14448,6888,14321,6483,14088,6171,15350,7402,15350,7419,15347,7480,15340,7613,15322,7804,15287,7973,15229,8057,15148,8012,15046,7846,14933,7611,14810,7357,14682,7069,14552,6656,14421,6316,14251,5948,14007,5528,15356,5942,15356,5977,15353,6119,15348,6294,15332,6551,15302,6824,15249,7044,15171,7122,15070,7050,14949,6861,14818,6611,14679,6349,14538,6067,14398,5651,14189,5311,13935,4958,15359,4123,15359,4153,15356,4296,15353,4646,15338,5160,15311,5508,15263,5829,15188,6042,15088,6094,14966,6001,14826,5796,14678,5543,14527,5287,14377,4985,14133,4586,13869,4257,15360,1563,15360,1642,15358,2076,15354,2636,15341,3350,15317,4019,15273,4429,15203,4732,15105,4911,14981,4932,14836,4818,14679,4621,14517,4386,14359,4156,14083,3795,13808,3437,15360,122,15360,137,15358,285,15355,636,15344,1274,15322,2177,15281,2765,15215,3223,15120,3451,14995,3569,14846,3567,14681,3466,14511,3305,14344,3121,14037,2800,13753,2467,15360,0,15360,1,15359,21,15355,89,15346,253,15325,479,15287,796,15225,1148,15133,1492,15008,1749,14856,1882,14685,1886,14506,1783,14324,1608,13996,1398,13702,1183]),mw=null;function hw(){return mw===null&&(mw=new X_(pw,16,16,hp,np),mw.name=`DFG_LUT`,mw.minFilter=Kf,mw.magFilter=Kf,mw.wrapS=Vf,mw.wrapT=Vf,mw.generateMipmaps=!1,mw.needsUpdate=!0),mw}var gw=class{constructor(e={}){let{canvas:t=vm(),context:n=null,depth:r=!0,stencil:i=!1,alpha:a=!1,antialias:o=!1,premultipliedAlpha:s=!0,preserveDrawingBuffer:c=!1,powerPreference:l=`default`,failIfMajorPerformanceCaveat:u=!1,reversedDepthBuffer:d=!1,outputBufferType:f=Yf}=e;this.isWebGLRenderer=!0;let p;if(n!==null){if(typeof WebGLRenderingContext<`u`&&n instanceof WebGLRenderingContext)throw Error(`THREE.WebGLRenderer: WebGL 1 is not supported since r163.`);p=n.getContextAttributes().alpha}else p=a;let m=f,h=new Set([_p,gp,mp]),g=new Set([Yf,ep,Qf,ap,rp,ip]),_=new Uint32Array(4),v=new Int32Array(4),y={textures:[],min:[],max:[],resolution:[]},b=null,x=null,S=[],C=[],w=null;this.domElement=t,this.debug={checkShaderErrors:!0,diagnostics:{keywords:!1},onShaderError:null},this.autoClear=!0,this.autoClearColor=!0,this.autoClearDepth=!0,this.autoClearStencil=!0,this.sortObjects=!0,this.clippingPlanes=[],this.localClippingEnabled=!1,this.toneMapping=0,this.toneMappingExposure=1,this.transmissionResolutionScale=1;let T=this,E=!1,D=null,O=null,ee=null,k=null;this._outputColorSpace=cm;let te=0,ne=0,re=null,ie=-1,ae=null,oe=new xh,se=new xh,ce=null,le=new sg(0),ue=0,de=t.width,fe=t.height,pe=1,me=null,he=null,ge=new xh(0,0,de,fe),_e=new xh(0,0,de,fe),ve=!1,ye=new ev,be=new nv,xe=!1,Se=!1,A=new Eh,Ce=new Q,we=new xh,Te={background:null,fog:null,environment:null,overrideMaterial:null,isScene:!0},Ee=!1;function De(){return re===null?pe:1}let j=n;function Oe(e,n){return t.getContext(e,n)}let ke,Ae,M,je,Me,Ne,Pe,Fe,Ie,Le,Re,ze,Be,Ve,He,Ue,We,Ge,Ke,qe,Je,Ye,Xe;try{let e={alpha:!0,depth:r,stencil:i,antialias:o,premultipliedAlpha:s,preserveDrawingBuffer:c,powerPreference:l,failIfMajorPerformanceCaveat:u};if(`setAttribute`in t&&t.setAttribute(`data-engine`,`three.js r187`),t.addEventListener(`webglcontextlost`,$e,!1),t.addEventListener(`webglcontextrestored`,et,!1),t.addEventListener(`webglcontextcreationerror`,tt,!1),j===null){let t=`webgl2`;if(j=Oe(t,e),j===null)throw Oe(t)?Error(`THREE.WebGLRenderer: Error creating WebGL context with your selected attributes.`):Error(`THREE.WebGLRenderer: Error creating WebGL context.`)}Ze()}catch(e){throw t.removeEventListener(`webglcontextlost`,$e,!1),t.removeEventListener(`webglcontextrestored`,et,!1),t.removeEventListener(`webglcontextcreationerror`,tt,!1),Cm(`WebGLRenderer: `+e.message),e}function Ze(){ke=new Ix(j),ke.init(),Je=new iw(j,ke),Ae=new gx(j,ke,e,Je),M=new nw(j,ke),Ae.reversedDepthBuffer&&d&&M.buffers.depth.setReversed(!0),O=j.createFramebuffer(),ee=j.createFramebuffer(),k=j.createFramebuffer(),je=new zx(j),Me=new IC,Ne=new rw(j,ke,M,Me,Ae,Je,je),Pe=new Fx(T),Fe=new sx(j),Ye=new mx(j,Fe),Ie=new Lx(j,Fe,je,Ye),Le=new Vx(j,Ie,Fe,Ye,je),Ge=new Bx(j,Ae,Ne),He=new _x(Me),Re=new FC(T,Pe,ke,Ae,Ye,He),ze=new dw(T,Me),Be=new BC,Ve=new qC(ke),We=new px(T,Pe,M,Le,p,s),Ue=new tw(T,Le,Ae),Xe=new fw(j,je,Ae,M),Ke=new hx(j,ke,je),qe=new Rx(j,ke,je),je.programs=Re.programs,T.capabilities=Ae,T.extensions=ke,T.properties=Me,T.renderLists=Be,T.shadowMap=Ue,T.state=M,T.info=je}m!==1009&&(w=new Ux(m,t.width,t.height,o,r,i));let Qe=new cw(T,j);this.xr=Qe,this.getContext=function(){return j},this.getContextAttributes=function(){return j.getContextAttributes()},this.forceContextLoss=function(){let e=ke.get(`WEBGL_lose_context`);e&&e.loseContext()},this.forceContextRestore=function(){let e=ke.get(`WEBGL_lose_context`);e&&e.restoreContext()},this.getPixelRatio=function(){return pe},this.setPixelRatio=function(e){e!==void 0&&(pe=e,this.setSize(de,fe,!1))},this.getSize=function(e){return e.set(de,fe)},this.setSize=function(e,n,r=!0){Qe.isPresenting?Sm(`WebGLRenderer: Can't change size while VR device is presenting.`):(de=e,fe=n,t.width=Math.floor(e*pe),t.height=Math.floor(n*pe),r===!0&&(t.style.width=e+`px`,t.style.height=n+`px`),w!==null&&w.setSize(t.width,t.height),this.setViewport(0,0,e,n))},this.getDrawingBufferSize=function(e){return e.set(de*pe,fe*pe).floor()},this.setDrawingBufferSize=function(e,n,r){de=e,fe=n,pe=r,t.width=Math.floor(e*r),t.height=Math.floor(n*r),this.setViewport(0,0,e,n)},this.setEffects=function(e){if(m===1009)Cm(`WebGLRenderer: setEffects() requires outputBufferType set to HalfFloatType or FloatType.`);else{if(e){for(let t=0;t<e.length;t++)if(e[t].isOutputPass===!0){Sm(`WebGLRenderer: OutputPass is not needed in setEffects(). Tone mapping and color space conversion are applied automatically.`);break}}w.setEffects(e||[])}},this.getCurrentViewport=function(e){return e.copy(oe)},this.getViewport=function(e){return e.copy(ge)},this.setViewport=function(e,t,n,r){e.isVector4?ge.set(e.x,e.y,e.z,e.w):ge.set(e,t,n,r),M.viewport(oe.copy(ge).multiplyScalar(De()).round())},this.getScissor=function(e){return e.copy(_e)},this.setScissor=function(e,t,n,r){e.isVector4?_e.set(e.x,e.y,e.z,e.w):_e.set(e,t,n,r),M.scissor(se.copy(_e).multiplyScalar(De()).round())},this.getScissorTest=function(){return ve},this.setScissorTest=function(e){M.setScissorTest(ve=e)},this.setOpaqueSort=function(e){me=e},this.setTransparentSort=function(e){he=e},this.getClearColor=function(e){return e.copy(We.getClearColor())},this.setClearColor=function(){We.setClearColor(...arguments)},this.getClearAlpha=function(){return We.getClearAlpha()},this.setClearAlpha=function(){We.setClearAlpha(...arguments)},this.clear=function(e=!0,t=!0,n=!0){let r=0;if(e){let e=!1;if(re!==null){let t=re.texture.format;e=h.has(t)}if(e){let e=re.texture.type,t=g.has(e),n=We.getClearColor(),r=We.getClearAlpha(),i=n.r,a=n.g,o=n.b;t?(_[0]=i,_[1]=a,_[2]=o,_[3]=r,j.clearBufferuiv(j.COLOR,0,_)):(v[0]=i,v[1]=a,v[2]=o,v[3]=r,j.clearBufferiv(j.COLOR,0,v))}else r|=j.COLOR_BUFFER_BIT}t&&(r|=j.DEPTH_BUFFER_BIT,this.state.buffers.depth.setMask(!0)),n&&(r|=j.STENCIL_BUFFER_BIT,this.state.buffers.stencil.setMask(4294967295)),r!==0&&j.clear(r)},this.clearColor=function(){this.clear(!0,!1,!1)},this.clearDepth=function(){this.clear(!1,!0,!1)},this.clearStencil=function(){this.clear(!1,!1,!0)},this.setNodesHandler=function(e){e.setRenderer(this),D=e},this.dispose=function(){t.removeEventListener(`webglcontextlost`,$e,!1),t.removeEventListener(`webglcontextrestored`,et,!1),t.removeEventListener(`webglcontextcreationerror`,tt,!1),We.dispose(),Be.dispose(),Ve.dispose(),Ne.dispose(),Me.dispose(),Pe.dispose(),Le.dispose(),Ie.dispose(),Ye.dispose(),Xe.dispose(),Re.dispose(),Qe.dispose(),Qe.removeEventListener(`sessionstart`,ct),Qe.removeEventListener(`sessionend`,lt),ut.stop()};function $e(e){e.preventDefault(),bm(`WebGLRenderer: Context Lost.`),E=!0}function et(){bm(`WebGLRenderer: Context Restored.`),E=!1;let e=je.autoReset,t=Ue.enabled,n=Ue.autoUpdate,r=Ue.needsUpdate,i=Ue.type;Ze(),je.autoReset=e,Ue.enabled=t,Ue.autoUpdate=n,Ue.needsUpdate=r,Ue.type=i}function tt(e){Cm(`WebGLRenderer: A WebGL context could not be created. Reason: `,e.statusMessage)}function nt(e){let t=e.target;t.removeEventListener(`dispose`,nt),rt(t)}function rt(e){it(e),Me.remove(e)}function it(e){let t=Me.get(e).programs;t!==void 0&&(t.forEach(function(e){Re.releaseProgram(e)}),e.isShaderMaterial&&Re.releaseShaderCache(e))}this.renderBufferDirect=function(e,t,n,r,i,a){t===null&&(t=Te);let o=i.isMesh&&i.matrixWorld.determinantAffine()<0,s=bt(e,t,n,r,i);M.setMaterial(r,o);let c=n.index,l=1;if(r.wireframe===!0){if(c=Ie.getWireframeAttribute(n),c===void 0)return;l=2}let u=n.drawRange,d=n.attributes.position,f=u.start*l,p=(u.start+u.count)*l;a!==null&&(f=Math.max(f,a.start*l),p=Math.min(p,(a.start+a.count)*l)),c===null?d!=null&&(f=Math.max(f,0),p=Math.min(p,d.count)):(f=Math.max(f,0),p=Math.min(p,c.count));let m=p-f;if(m<0||m===1/0)return;Ye.setup(i,r,s,n,c);let h,g=Ke;if(c!==null&&(h=Fe.get(c),g=qe,g.setIndex(h)),i.isMesh)r.wireframe===!0?(M.setLineWidth(r.wireframeLinewidth*De()),g.setMode(j.LINES)):g.setMode(j.TRIANGLES);else if(i.isLine){let e=r.linewidth;e===void 0&&(e=1),M.setLineWidth(e*De()),i.isLineSegments?g.setMode(j.LINES):i.isLineLoop?g.setMode(j.LINE_LOOP):g.setMode(j.LINE_STRIP)}else i.isPoints?g.setMode(j.POINTS):i.isSprite&&g.setMode(j.TRIANGLES);if(i.isBatchedMesh){if(ke.get(`WEBGL_multi_draw`))g.renderMultiDraw(i._multiDrawStarts,i._multiDrawCounts,i._multiDrawCount);else{let e=i._multiDrawStarts,t=i._multiDrawCounts,n=i._multiDrawCount,a=c?Fe.get(c).bytesPerElement:1,o=Me.get(r).currentProgram.getUniforms();for(let r=0;r<n;r++)o.setValue(j,`_gl_DrawID`,r),g.render(e[r]/a,t[r])}}else if(i.isInstancedMesh)g.renderInstances(f,m,i.count);else if(n.isInstancedBufferGeometry){let e=n._maxInstanceCount===void 0?1/0:n._maxInstanceCount,t=Math.min(n.instanceCount,e);g.renderInstances(f,m,t)}else g.render(f,m)};function at(e,t,n,r){D!==null&&e.isNodeMaterial&&D.setObject(r,e),xe===!0&&He.setState(e,n,!1),e.transparent===!0&&e.side===2&&e.forceSinglePass===!1?(e.side=1,e.needsUpdate=!0,gt(e,t,r),e.side=0,e.needsUpdate=!0,gt(e,t,r),e.side=2):gt(e,t,r)}this.compile=function(e,t,n=null){n===null&&(n=e),D!==null&&D.renderStart(e,t,n),x=Ve.get(n),x.init(t),C.push(x),n.traverseVisible(function(e){e.isLight&&e.layers.test(t.layers)&&(x.pushLight(e),e.castShadow&&x.pushShadow(e))}),e!==n&&e.traverseVisible(function(e){e.isLight&&e.layers.test(t.layers)&&(x.pushLight(e),e.castShadow&&x.pushShadow(e))}),x.setupLights(),D!==null&&D.updateLights(x.state.lightsArray),Se=this.localClippingEnabled,xe=He.init(this.clippingPlanes,Se),xe===!0&&He.setGlobalState(this.clippingPlanes,t),D!==null&&Ue.render(x.state.shadowsArray,n,t);let r=new Set;return e.traverse(function(e){if(!(e.isMesh||e.isPoints||e.isLine||e.isSprite))return;let i=e.material;if(i){if(Array.isArray(i))for(let a=0;a<i.length;a++){let o=i[a];at(o,n,t,e),r.add(o)}else at(i,n,t,e),r.add(i)}}),x=C.pop(),D!==null&&D.renderEnd(),r},this.compileAsync=function(e,t,n=null){let r=this.compile(e,t,n);return new Promise(t=>{function n(){r.forEach(function(e){let t=Me.get(e).currentProgram;(t===void 0||t.isReady())&&r.delete(e)}),r.size===0?t(e):setTimeout(n,10)}ke.get(`KHR_parallel_shader_compile`)===null?setTimeout(n,10):n()})};let ot=null;function st(e){ot&&ot(e)}function ct(){ut.stop()}function lt(){ut.start()}let ut=new ox;ut.setAnimationLoop(st),typeof self<`u`&&ut.setContext(self),this.setAnimationLoop=function(e){ot=e,Qe.setAnimationLoop(e),e===null?ut.stop():ut.start()},Qe.addEventListener(`sessionstart`,ct),Qe.addEventListener(`sessionend`,lt),this.render=function(e,t){if(t!==void 0&&t.isCamera!==!0){Cm(`WebGLRenderer.render: camera is not an instance of THREE.Camera.`);return}if(E===!0)return;D!==null&&D.renderStart(e,t);let n=Qe.enabled===!0&&Qe.isPresenting===!0,r=w!==null&&(re===null||n)&&w.begin(T,re);if(e.matrixWorldAutoUpdate===!0&&e.updateMatrixWorld(),t.parent===null&&t.matrixWorldAutoUpdate===!0&&t.updateMatrixWorld(),Qe.enabled===!0&&Qe.isPresenting===!0&&(w===null||w.isCompositing()===!1)&&(Qe.cameraAutoUpdate===!0&&Qe.updateCamera(t),t=Qe.getCamera()),e.isScene===!0&&e.onBeforeRender(T,e,t,re),x=Ve.get(e,C.length),x.init(t),x.state.textureUnits=Ne.getTextureUnits(),C.push(x),A.multiplyMatrices(t.projectionMatrix,t.matrixWorldInverse),t.isArrayCamera?be.setFromArrayCamera(t):ye.setFromProjectionMatrix(A,mm,t.reversedDepth),Se=this.localClippingEnabled,xe=He.init(this.clippingPlanes,Se),b=Be.get(e,S.length),b.init(),S.push(b),this.info.render.frame++,Qe.enabled===!0&&Qe.isPresenting===!0){let e=T.xr.getDepthSensingMesh();e!==null&&N(e,t,-1/0,T.sortObjects)}N(e,t,0,T.sortObjects),b.finish(),D!==null&&D.updateLights(x.state.lightsArray),T.sortObjects===!0&&b.sort(me,he),Ee=Qe.enabled===!1||Qe.isPresenting===!1||Qe.hasDepthSensing()===!1,Ee&&We.addToRenderList(b,e),this.info.autoReset===!0&&this.info.reset(),xe===!0&&He.beginShadows();let i=x.state.shadowsArray;if(Ue.render(i,e,t),xe===!0&&He.endShadows(),(r&&w.hasRenderPass())===!1){let n=b.opaque,r=b.transmissive;if(x.setupLights(),t.isArrayCamera){let i=t.cameras;if(r.length>0)for(let t=0,a=i.length;t<a;t++){let a=i[t];ft(n,r,e,a)}Ee&&We.render(e);for(let t=0,n=i.length;t<n;t++){let n=i[t];dt(b,e,n,n.viewport)}}else r.length>0&&ft(n,r,e,t),Ee&&We.render(e),dt(b,e,t)}re!==null&&ne===0&&(Ne.updateMultisampleRenderTarget(re),Ne.updateRenderTargetMipmap(re)),r&&w.end(T),e.isScene===!0&&e.onAfterRender(T,e,t),Ye.resetDefaultState(),ie=-1,ae=null,C.pop(),C.length>0?(x=C[C.length-1],Ne.setTextureUnits(x.state.textureUnits),xe===!0&&He.setGlobalState(T.clippingPlanes,x.state.camera)):x=null,S.pop(),b=S.length>0?S[S.length-1]:null,D!==null&&D.renderEnd()};function N(e,t,n,r){if(e.visible===!1)return;if(e.layers.test(t.layers)){if(e.isGroup)n=e.renderOrder;else if(e.isLOD)e.autoUpdate===!0&&e.update(t);else if(e.isLight)x.pushLight(e),e.castShadow&&x.pushShadow(e);else if(e.isSprite){let i=t.isArrayCamera?be:ye;if(!e.frustumCulled||e.intersectsFrustum(i)){r&&we.setFromMatrixPosition(e.matrixWorld).applyMatrix4(A);let i=Le.update(e),a=e.material;a.visible&&b.push(e,i,a,n,we.z,null,t)}}else if(e.isMesh||e.isLine||e.isPoints){let i=t.isArrayCamera?be:ye;if(!e.frustumCulled||e.intersectsFrustum(i)){let i=Le.update(e),a=e.material;if(r&&(e.boundingSphere===void 0?(i.boundingSphere===null&&i.computeBoundingSphere(),we.copy(i.boundingSphere.center)):(e.boundingSphere===null&&e.computeBoundingSphere(),we.copy(e.boundingSphere.center)),we.applyMatrix4(e.matrixWorld).applyMatrix4(A)),Array.isArray(a)){let r=i.groups;for(let o=0,s=r.length;o<s;o++){let s=r[o],c=a[s.materialIndex];c&&c.visible&&b.push(e,i,c,n,we.z,s,t)}}else a.visible&&b.push(e,i,a,n,we.z,null,t)}}}let i=e.children;for(let e=0,a=i.length;e<a;e++)N(i[e],t,n,r)}function dt(e,t,n,r){let{opaque:i,transmissive:a,transparent:o}=e;x.setupLightsView(n),xe===!0&&He.setGlobalState(T.clippingPlanes,n),r&&M.viewport(oe.copy(r)),i.length>0&&pt(i,t,n),a.length>0&&pt(a,t,n),o.length>0&&pt(o,t,n),M.buffers.depth.setTest(!0),M.buffers.depth.setMask(!0),M.buffers.color.setMask(!0),M.setPolygonOffset(!1)}function ft(e,t,n,r){if((n.isScene===!0?n.overrideMaterial:null)!==null)return;if(x.state.transmissionRenderTarget[r.id]===void 0){let e=ke.has(`EXT_color_buffer_half_float`)||ke.has(`EXT_color_buffer_float`);x.state.transmissionRenderTarget[r.id]=new Ch(1,1,{generateMipmaps:!0,type:e?np:Yf,minFilter:Jf,samples:Math.max(4,Ae.samples),stencilBuffer:i,resolveDepthBuffer:!1,resolveStencilBuffer:!1,storeMultisampledDepthBuffer:!1,storeMultisampledStencilBuffer:!1,colorSpace:uh.workingColorSpace})}let a=x.state.transmissionRenderTarget[r.id],o=r.viewport||oe;a.setSize(o.z*T.transmissionResolutionScale,o.w*T.transmissionResolutionScale);let s=T.getRenderTarget(),c=T.getActiveCubeFace(),l=T.getActiveMipmapLevel();T.setRenderTarget(a),T.getClearColor(le),ue=T.getClearAlpha(),ue<1&&T.setClearColor(16777215,.5),T.clear(),Ee&&We.render(n);let u=T.toneMapping;T.toneMapping=0;let d=r.viewport;if(r.viewport!==void 0&&(r.viewport=void 0),x.setupLightsView(r),xe===!0&&He.setGlobalState(T.clippingPlanes,r),pt(e,n,r),Ne.updateMultisampleRenderTarget(a),Ne.updateRenderTargetMipmap(a),ke.has(`WEBGL_multisampled_render_to_texture`)===!1){let e=!1;for(let i=0,a=t.length;i<a;i++){let{object:a,geometry:o,material:s,group:c}=t[i];if(s.side===2&&a.layers.test(r.layers)){let t=s.side;s.side=1,s.needsUpdate=!0,mt(a,n,r,o,s,c),s.side=t,s.needsUpdate=!0,e=!0}}e===!0&&(Ne.updateMultisampleRenderTarget(a),Ne.updateRenderTargetMipmap(a))}T.setRenderTarget(s,c,l),T.setClearColor(le,ue),d!==void 0&&(r.viewport=d),T.toneMapping=u}function pt(e,t,n){let r=t.isScene===!0?t.overrideMaterial:null;for(let i=0,a=e.length;i<a;i++){let a=e[i],{object:o,geometry:s,group:c}=a,l=a.material;l.allowOverride===!0&&r!==null&&(l=r),o.layers.test(n.layers)&&mt(o,t,n,s,l,c)}}function mt(e,t,n,r,i,a){D!==null&&i.isNodeMaterial&&D.setObject(e,i),e.onBeforeRender(T,t,n,r,i,a),e.modelViewMatrix.multiplyMatrices(n.matrixWorldInverse,e.matrixWorld),e.normalMatrix.getNormalMatrix(e.modelViewMatrix),i.onBeforeRender(T,t,n,r,e,a),i.transparent===!0&&i.side===2&&i.forceSinglePass===!1?(i.side=1,i.needsUpdate=!0,T.renderBufferDirect(n,t,r,i,e,a),i.side=0,i.needsUpdate=!0,T.renderBufferDirect(n,t,r,i,e,a),i.side=2):T.renderBufferDirect(n,t,r,i,e,a),e.onAfterRender(T,t,n,r,i,a)}function ht(e){let t=0;for(let n of e)n.texture!==null&&t++;return t}function gt(e,t,n){t.isScene!==!0&&(t=Te);let r=Me.get(e),i=x.state.lights,a=x.state.shadowsArray,o=i.state.version,s=Re.getParameters(e,i.state,a,t,n,x.state.lightProbeGridArray),c=Re.getProgramCacheKey(s),l=r.programs;r.environment=e.isMeshStandardMaterial||e.isMeshLambertMaterial||e.isMeshPhongMaterial?t.environment:null,r.fog=t.fog;let u=e.isMeshStandardMaterial||e.isMeshLambertMaterial&&!e.envMap||e.isMeshPhongMaterial&&!e.envMap;r.envMap=Pe.get(e.envMap||r.environment,u),r.envMapRotation=r.environment!==null&&e.envMap===null?t.environmentRotation:e.envMapRotation,l===void 0&&(e.addEventListener(`dispose`,nt),l=new Map,r.programs=l,r.programVariants=new Map);let d=l.get(c);if(d!==void 0){if(r.currentProgram===d&&r.lightsStateVersion===o)return yt(e,s),d}else s.uniforms=Re.getUniforms(e),D!==null&&e.isNodeMaterial&&D.build(e,n,s),e.onBeforeCompile(s,T),d=Re.acquireProgram(s,c),l.set(c,d),r.uniforms=s.uniforms;let f=r.uniforms;return(!e.isShaderMaterial&&!e.isRawShaderMaterial||e.clipping===!0)&&(f.clippingPlanes=He.uniform),yt(e,s),r.needsLights=St(e),r.lightsStateVersion=o,r.needsLights&&(f.ambientLightColor.value=i.state.ambient,f.lightProbe.value=i.state.probe,f.sunLights.value=i.state.sun,f.sunLightShadows.value=i.state.sunShadow,f.directionalLights.value=i.state.directional,f.directionalLightShadows.value=i.state.directionalShadow,f.spotLights.value=i.state.spot,f.spotLightShadows.value=i.state.spotShadow,f.rectAreaLights.value=i.state.rectArea,f.ltc_1.value=i.state.rectAreaLTC1,f.ltc_2.value=i.state.rectAreaLTC2,f.pointLights.value=i.state.point,f.pointLightShadows.value=i.state.pointShadow,f.hemisphereLights.value=i.state.hemi,f.sunShadowMatrix.value=i.state.sunShadowMatrix,f.sunShadowCascade.value=i.state.sunShadowCascade,f.directionalShadowMatrix.value=i.state.directionalShadowMatrix,f.spotLightMatrix.value=i.state.spotLightMatrix,f.spotLightMap.value=i.state.spotLightMap,f.pointShadowMatrix.value=i.state.pointShadowMatrix),r.numLightProbeGrids=ht(x.state.lightProbeGridArray),r.currentProgram=d,r.uniformsList=null,d}function _t(e,t,n,r,i){let a=Me.get(e),o=a.currentProgram.id+`,`+r+`,`+i,s=a.programVariants.get(o);return s===void 0?(s=gt(e,t,n),a.programVariants.set(o,s)):(a.currentProgram=s,a.uniformsList=null,a.outputColorSpace=r,a.toneMapping=i),s}function vt(e){if(e.uniformsList===null){let t=e.currentProgram.getUniforms();e.uniformsList=QS.seqWithValue(t.seq,e.uniforms)}return e.uniformsList}function yt(e,t){let n=Me.get(e);n.outputColorSpace=t.outputColorSpace,n.batching=t.batching,n.batchingColor=t.batchingColor,n.instancing=t.instancing,n.instancingColor=t.instancingColor,n.instancingMorph=t.instancingMorph,n.skinning=t.skinning,n.morphTargets=t.morphTargets,n.morphNormals=t.morphNormals,n.morphColors=t.morphColors,n.morphTargetsCount=t.morphTargetsCount,n.numClippingPlanes=t.numClippingPlanes,n.numIntersection=t.numClipIntersection,n.vertexAlphas=t.vertexAlphas,n.vertexTangents=t.vertexTangents,n.toneMapping=t.toneMapping}function bt(e,t,n,r,i){t.isScene!==!0&&(t=Te),Ne.resetTextureUnits();let a=t.fog,o=r.isMeshStandardMaterial||r.isMeshLambertMaterial||r.isMeshPhongMaterial?t.environment:null,s=re===null?T.outputColorSpace:re.isXRRenderTarget===!0?re.texture.colorSpace:uh.workingColorSpace,c=r.isMeshStandardMaterial||r.isMeshLambertMaterial&&!r.envMap||r.isMeshPhongMaterial&&!r.envMap,l=Pe.get(r.envMap||o,c),u=r.vertexColors===!0&&!!n.attributes.color&&n.attributes.color.itemSize===4,d=!!n.attributes.tangent&&(!!r.normalMap||r.anisotropy>0),f=!!n.morphAttributes.position,p=!!n.morphAttributes.normal,m=!!n.morphAttributes.color,h=0;r.toneMapped&&(re===null||re.isXRRenderTarget===!0)&&(h=T.toneMapping);let g=n.morphAttributes.position||n.morphAttributes.normal||n.morphAttributes.color,_=g===void 0?0:g.length,v=Me.get(r),b=x.state.lights;if(xe===!0&&(Se===!0||e!==ae)){let t=e===ae&&r.id===ie;He.setState(r,e,t)}let S=!1,C=!1;r.version===v.__version?v.needsLights&&v.lightsStateVersion!==b.state.version||i.isBatchedMesh&&v.batching===!1||!i.isBatchedMesh&&v.batching===!0||i.isBatchedMesh&&v.batchingColor===!0&&i._colorsTexture===null||i.isBatchedMesh&&v.batchingColor===!1&&i._colorsTexture!==null||i.isInstancedMesh&&v.instancing===!1||!i.isInstancedMesh&&v.instancing===!0||i.isSkinnedMesh&&v.skinning===!1||!i.isSkinnedMesh&&v.skinning===!0||i.isInstancedMesh&&v.instancingColor===!0&&i.instanceColor===null||i.isInstancedMesh&&v.instancingColor===!1&&i.instanceColor!==null||i.isInstancedMesh&&v.instancingMorph===!0&&i.morphTexture===null||i.isInstancedMesh&&v.instancingMorph===!1&&i.morphTexture!==null?S=!0:v.envMap===l?r.fog===!0&&v.fog!==a||v.numClippingPlanes!==void 0&&(v.numClippingPlanes!==He.numPlanes||v.numIntersection!==He.numIntersection)?S=!0:v.vertexAlphas===u&&v.vertexTangents===d&&v.morphTargets===f&&v.morphNormals===p&&v.morphColors===m&&v.morphTargetsCount===_&&v.numLightProbeGrids===ht(x.state.lightProbeGridArray)?(v.outputColorSpace!==s||v.toneMapping!==h)&&(C=!0):S=!0:S=!0:(S=!0,v.__version=r.version);let w=v.currentProgram;(S===!0||C===!0)&&(w=C===!0?_t(r,t,i,s,h):gt(r,t,i),D&&r.isNodeMaterial&&D.onUpdateProgram(r,w,v));let E=!1,O=!1,ee=!1,k=w.getUniforms(),te=v.uniforms;if(M.useProgram(w.program)&&(E=!0,O=!0,ee=!0),r.id!==ie&&(ie=r.id,O=!0),E||ae!==e){M.buffers.depth.getReversed()&&e.reversedDepth!==!0&&(e._reversedDepth=!0,e.updateProjectionMatrix()),k.setValue(j,`projectionMatrix`,e.projectionMatrix),k.setValue(j,`viewMatrix`,e.matrixWorldInverse);let t=k.map.cameraPosition;t!==void 0&&t.setValue(j,Ce.setFromMatrixPosition(e.matrixWorld)),Ae.logarithmicDepthBuffer&&k.setValue(j,`logDepthBufFC`,2/(Math.log(e.far+1)/Math.LN2)),(r.isMeshPhongMaterial||r.isMeshToonMaterial||r.isMeshLambertMaterial||r.isMeshBasicMaterial||r.isMeshStandardMaterial||r.isShaderMaterial)&&k.setValue(j,`isOrthographic`,e.isOrthographicCamera===!0),ae!==e&&(ae=e,O=!0,ee=!0)}if(v.needsLights&&(b.state.sunShadowMap.length>0&&k.setValue(j,`sunShadowMap`,b.state.sunShadowMap,Ne),b.state.directionalShadowMap.length>0&&k.setValue(j,`directionalShadowMap`,b.state.directionalShadowMap,Ne),b.state.spotShadowMap.length>0&&k.setValue(j,`spotShadowMap`,b.state.spotShadowMap,Ne),b.state.pointShadowMap.length>0&&k.setValue(j,`pointShadowMap`,b.state.pointShadowMap,Ne)),i.isSkinnedMesh){k.setOptional(j,i,`bindMatrix`),k.setOptional(j,i,`bindMatrixInverse`);let e=i.skeleton;e&&(e.boneTexture===null&&e.computeBoneTexture(),k.setValue(j,`boneTexture`,e.boneTexture,Ne))}i.isBatchedMesh&&(k.setOptional(j,i,`batchingTexture`),k.setValue(j,`batchingTexture`,i._matricesTexture,Ne),k.setOptional(j,i,`batchingIdTexture`),k.setValue(j,`batchingIdTexture`,i._indirectTexture,Ne),k.setOptional(j,i,`batchingColorTexture`),i._colorsTexture!==null&&k.setValue(j,`batchingColorTexture`,i._colorsTexture,Ne));let ne=n.morphAttributes;if((ne.position!==void 0||ne.normal!==void 0||ne.color!==void 0)&&Ge.update(i,n,w),(O||v.receiveShadow!==i.receiveShadow)&&(v.receiveShadow=i.receiveShadow,k.setValue(j,`receiveShadow`,i.receiveShadow)),(r.isMeshStandardMaterial||r.isMeshLambertMaterial||r.isMeshPhongMaterial)&&r.envMap===null&&t.environment!==null&&(te.envMapIntensity.value=t.environmentIntensity),te.dfgLUT!==void 0&&(te.dfgLUT.value=hw()),O){if(k.setValue(j,`toneMappingExposure`,T.toneMappingExposure),v.needsLights&&xt(te,ee),a&&r.fog===!0&&ze.refreshFogUniforms(te,a),ze.refreshMaterialUniforms(te,r,pe,fe,x.state.transmissionRenderTarget[e.id]),v.needsLights&&v.numLightProbeGrids>0){let e=y,t=0;for(let n of x.state.lightProbeGridArray)n.texture!==null&&(e.textures[t]=n.texture,e.min[t]=n.boundingBox.min,e.max[t]=n.boundingBox.max,e.resolution[t]=n.resolution,t++);for(let n in e)e[n].length=t;te.probesSH.value=e.textures,te.probesMin.value=e.min,te.probesMax.value=e.max,te.probesResolution.value=e.resolution}QS.upload(j,vt(v),te,Ne)}if(r.isShaderMaterial&&r.uniformsNeedUpdate===!0&&(QS.upload(j,vt(v),te,Ne),r.uniformsNeedUpdate=!1),r.isSpriteMaterial&&k.setValue(j,`center`,i.center),k.setValue(j,`modelViewMatrix`,i.modelViewMatrix),k.setValue(j,`normalMatrix`,i.normalMatrix),k.setValue(j,`modelMatrix`,i.matrixWorld),r.uniformsGroups!==void 0){let e=r.uniformsGroups;for(let t=0,n=e.length;t<n;t++){let n=e[t];Xe.update(n,w),Xe.bind(n,w)}}return w}function xt(e,t){e.ambientLightColor.needsUpdate=t,e.lightProbe.needsUpdate=t,e.sunLights.needsUpdate=t,e.sunLightShadows.needsUpdate=t,e.directionalLights.needsUpdate=t,e.directionalLightShadows.needsUpdate=t,e.pointLights.needsUpdate=t,e.pointLightShadows.needsUpdate=t,e.spotLights.needsUpdate=t,e.spotLightShadows.needsUpdate=t,e.rectAreaLights.needsUpdate=t,e.hemisphereLights.needsUpdate=t}function St(e){return e.isMeshLambertMaterial||e.isMeshToonMaterial||e.isMeshPhongMaterial||e.isMeshStandardMaterial||e.isShadowMaterial||e.isShaderMaterial&&e.lights===!0}this.getActiveCubeFace=function(){return te},this.getActiveMipmapLevel=function(){return ne},this.getRenderTarget=function(){return re},this.setRenderTargetTextures=function(e,t,n){let r=Me.get(e);r.__autoAllocateDepthBuffer=e.resolveDepthBuffer===!1,r.__autoAllocateDepthBuffer===!1&&(r.__useRenderToTexture=!1),Me.get(e.texture).__webglTexture=t,Me.get(e.depthTexture).__webglTexture=r.__autoAllocateDepthBuffer?void 0:n,r.__hasExternalTextures=!0},this.setRenderTargetFramebuffer=function(e,t){let n=Me.get(e);n.__webglFramebuffer=t,n.__useDefaultFramebuffer=t===void 0},this.setRenderTarget=function(e,t=0,n=0){re=e,te=t,ne=n;let r=null,i=!1,a=!1;if(e){let o=Me.get(e);if(o.__useDefaultFramebuffer!==void 0){M.bindFramebuffer(j.FRAMEBUFFER,o.__webglFramebuffer),oe.copy(e.viewport),se.copy(e.scissor),ce=e.scissorTest,M.viewport(oe),M.scissor(se),M.setScissorTest(ce),ie=-1;return}if(o.__webglFramebuffer===void 0)Ne.setupRenderTarget(e);else if(o.__hasExternalTextures)Ne.rebindTextures(e,Me.get(e.texture).__webglTexture,Me.get(e.depthTexture).__webglTexture);else if(e.depthBuffer){let t=e.depthTexture;if(o.__boundDepthTexture!==t){if(t!==null&&Me.has(t)&&(e.width!==t.image.width||e.height!==t.image.height))throw Error(`THREE.WebGLRenderer: Attached DepthTexture is initialized to the incorrect size.`);Ne.setupDepthRenderbuffer(e)}}let s=e.texture;(s.isData3DTexture||s.isDataArrayTexture||s.isCompressedArrayTexture)&&(a=!0);let c=Me.get(e).__webglFramebuffer;e.isWebGLCubeRenderTarget?(r=Array.isArray(c[t])?c[t][n]:c[t],i=!0):r=e.samples>0&&Ne.useMultisampledRTT(e)===!1?Me.get(e).__webglMultisampledFramebuffer:Array.isArray(c)?c[n]:c,oe.copy(e.viewport),se.copy(e.scissor),ce=e.scissorTest}else oe.copy(ge).multiplyScalar(pe).floor(),se.copy(_e).multiplyScalar(pe).floor(),ce=ve;if(n!==0&&(r=O),M.bindFramebuffer(j.FRAMEBUFFER,r)&&M.drawBuffers(e,r),M.viewport(oe),M.scissor(se),M.setScissorTest(ce),i){let r=Me.get(e.texture);j.framebufferTexture2D(j.FRAMEBUFFER,j.COLOR_ATTACHMENT0,j.TEXTURE_CUBE_MAP_POSITIVE_X+t,r.__webglTexture,n)}else if(a){let r=t;for(let t=0;t<e.textures.length;t++){let i=Me.get(e.textures[t]);j.framebufferTextureLayer(j.FRAMEBUFFER,j.COLOR_ATTACHMENT0+t,i.__webglTexture,n,r)}}else if(e!==null&&n!==0){let t=Me.get(e.texture);j.framebufferTexture2D(j.FRAMEBUFFER,j.COLOR_ATTACHMENT0,j.TEXTURE_2D,t.__webglTexture,n)}ie=-1};function Ct(e){let t=Me.get(e);return(t.__readFormat!==e.format||t.__readType!==e.type)&&(t.__readFormat=e.format,t.__readType=e.type,t.__formatReadable=Ae.textureFormatReadable(e.format),t.__typeReadable=Ae.textureTypeReadable(e.type)),t}this.readRenderTargetPixels=function(e,t,n,r,i,a,o,s=0){if(!(e&&e.isWebGLRenderTarget)){Cm(`WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.`);return}let c=Me.get(e).__webglFramebuffer;if(e.isWebGLCubeRenderTarget&&o!==void 0&&(c=c[o],Array.isArray(c)&&(c=c[0])),c){M.bindFramebuffer(j.FRAMEBUFFER,c);try{let o=e.textures[s],c=o.format,l=o.type;e.textures.length>1&&j.readBuffer(j.COLOR_ATTACHMENT0+s);let u=Ct(o);if(u.__formatReadable===!1){Cm(`WebGLRenderer.readRenderTargetPixels: renderTarget is not in RGBA or implementation defined format.`);return}if(u.__typeReadable===!1){Cm(`WebGLRenderer.readRenderTargetPixels: renderTarget is not in UnsignedByteType or implementation defined type.`);return}t>=0&&t<=e.width-r&&n>=0&&n<=e.height-i&&j.readPixels(t,n,r,i,Je.convert(c),Je.convert(l),a)}finally{let e=re===null?null:Me.get(re).__webglFramebuffer;M.bindFramebuffer(j.FRAMEBUFFER,e)}}},this.readRenderTargetPixelsAsync=async function(e,t,n,r,i,a,o,s=0){if(!(e&&e.isWebGLRenderTarget))throw Error(`THREE.WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.`);let c=Me.get(e).__webglFramebuffer;if(e.isWebGLCubeRenderTarget&&o!==void 0&&(c=c[o],Array.isArray(c)&&(c=c[0])),c){if(t>=0&&t<=e.width-r&&n>=0&&n<=e.height-i){M.bindFramebuffer(j.FRAMEBUFFER,c);let o=e.textures[s],l=o.format,u=o.type;e.textures.length>1&&j.readBuffer(j.COLOR_ATTACHMENT0+s);let d=Ct(o);if(d.__formatReadable===!1)throw Error(`THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in RGBA or implementation defined format.`);if(d.__typeReadable===!1)throw Error(`THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in UnsignedByteType or implementation defined type.`);let f=j.createBuffer();j.bindBuffer(j.PIXEL_PACK_BUFFER,f),j.bufferData(j.PIXEL_PACK_BUFFER,a.byteLength,j.STREAM_READ),j.readPixels(t,n,r,i,Je.convert(l),Je.convert(u),0),j.bindBuffer(j.PIXEL_PACK_BUFFER,null);let p=re===null?null:Me.get(re).__webglFramebuffer;M.bindFramebuffer(j.FRAMEBUFFER,p);let m=j.fenceSync(j.SYNC_GPU_COMMANDS_COMPLETE,0);return j.flush(),await Tm(j,m,4),j.bindBuffer(j.PIXEL_PACK_BUFFER,f),j.getBufferSubData(j.PIXEL_PACK_BUFFER,0,a),j.bindBuffer(j.PIXEL_PACK_BUFFER,null),j.deleteBuffer(f),j.deleteSync(m),a}throw Error(`THREE.WebGLRenderer.readRenderTargetPixelsAsync: requested read bounds are out of range.`)}},this.copyFramebufferToTexture=function(e,t=null,n=0){let r=2**-n,i=Math.floor(e.image.width*r),a=Math.floor(e.image.height*r),o=t===null?0:t.x,s=t===null?0:t.y;Ne.setTexture2D(e,0),j.copyTexSubImage2D(j.TEXTURE_2D,n,0,0,o,s,i,a),M.unbindTexture()},this.copyTextureToTexture=function(e,t,n=null,r=null,i=0,a=0){let o,s,c,l,u,d,f,p,m,h=e.isCompressedTexture?e.mipmaps[a]:e.image;if(n!==null)o=n.max.x-n.min.x,s=n.max.y-n.min.y,c=n.isBox3?n.max.z-n.min.z:1,l=n.min.x,u=n.min.y,d=n.isBox3?n.min.z:0;else{let t=2**-i;o=Math.floor(h.width*t),s=Math.floor(h.height*t),c=e.isDataArrayTexture?h.depth:e.isData3DTexture?Math.floor(h.depth*t):1,l=0,u=0,d=0}r===null?(f=0,p=0,m=0):(f=r.x,p=r.y,m=r.z);let g=Je.convert(t.format),_=Je.convert(t.type),v;t.isData3DTexture?(Ne.setTexture3D(t,0),v=j.TEXTURE_3D):t.isDataArrayTexture||t.isCompressedArrayTexture?(Ne.setTexture2DArray(t,0),v=j.TEXTURE_2D_ARRAY):(Ne.setTexture2D(t,0),v=j.TEXTURE_2D),M.activeTexture(j.TEXTURE0),M.pixelStorei(j.UNPACK_FLIP_Y_WEBGL,t.flipY),M.pixelStorei(j.UNPACK_PREMULTIPLY_ALPHA_WEBGL,t.premultiplyAlpha),M.pixelStorei(j.UNPACK_ALIGNMENT,t.unpackAlignment);let y=M.getParameter(j.UNPACK_ROW_LENGTH),b=M.getParameter(j.UNPACK_IMAGE_HEIGHT),x=M.getParameter(j.UNPACK_SKIP_PIXELS),S=M.getParameter(j.UNPACK_SKIP_ROWS),C=M.getParameter(j.UNPACK_SKIP_IMAGES);M.pixelStorei(j.UNPACK_ROW_LENGTH,h.width),M.pixelStorei(j.UNPACK_IMAGE_HEIGHT,h.height),M.pixelStorei(j.UNPACK_SKIP_PIXELS,l),M.pixelStorei(j.UNPACK_SKIP_ROWS,u),M.pixelStorei(j.UNPACK_SKIP_IMAGES,d);let w=e.isDataArrayTexture||e.isData3DTexture,T=t.isDataArrayTexture||t.isData3DTexture;if(e.isDepthTexture){let n=Me.get(e),r=Me.get(t),h=Me.get(n.__renderTarget),g=Me.get(r.__renderTarget);M.bindFramebuffer(j.READ_FRAMEBUFFER,h.__webglFramebuffer),M.bindFramebuffer(j.DRAW_FRAMEBUFFER,g.__webglFramebuffer);for(let n=0;n<c;n++)w&&(j.framebufferTextureLayer(j.READ_FRAMEBUFFER,j.COLOR_ATTACHMENT0,Me.get(e).__webglTexture,i,d+n),j.framebufferTextureLayer(j.DRAW_FRAMEBUFFER,j.COLOR_ATTACHMENT0,Me.get(t).__webglTexture,a,m+n)),j.blitFramebuffer(l,u,l+o,u+s,f,p,f+o,p+s,j.DEPTH_BUFFER_BIT,j.NEAREST);M.bindFramebuffer(j.READ_FRAMEBUFFER,null),M.bindFramebuffer(j.DRAW_FRAMEBUFFER,null)}else if(i!==0||e.isRenderTargetTexture||Me.has(e)){let n=Me.get(e),r=Me.get(t);M.bindFramebuffer(j.READ_FRAMEBUFFER,ee),M.bindFramebuffer(j.DRAW_FRAMEBUFFER,k);for(let e=0;e<c;e++)w?j.framebufferTextureLayer(j.READ_FRAMEBUFFER,j.COLOR_ATTACHMENT0,n.__webglTexture,i,d+e):j.framebufferTexture2D(j.READ_FRAMEBUFFER,j.COLOR_ATTACHMENT0,j.TEXTURE_2D,n.__webglTexture,i),T?j.framebufferTextureLayer(j.DRAW_FRAMEBUFFER,j.COLOR_ATTACHMENT0,r.__webglTexture,a,m+e):j.framebufferTexture2D(j.DRAW_FRAMEBUFFER,j.COLOR_ATTACHMENT0,j.TEXTURE_2D,r.__webglTexture,a),i===0?T?j.copyTexSubImage3D(v,a,f,p,m+e,l,u,o,s):j.copyTexSubImage2D(v,a,f,p,l,u,o,s):j.blitFramebuffer(l,u,l+o,u+s,f,p,f+o,p+s,j.COLOR_BUFFER_BIT,j.NEAREST);M.bindFramebuffer(j.READ_FRAMEBUFFER,null),M.bindFramebuffer(j.DRAW_FRAMEBUFFER,null)}else T?e.isDataTexture||e.isData3DTexture?j.texSubImage3D(v,a,f,p,m,o,s,c,g,_,h.data):t.isCompressedArrayTexture?j.compressedTexSubImage3D(v,a,f,p,m,o,s,c,g,h.data):j.texSubImage3D(v,a,f,p,m,o,s,c,g,_,h):e.isDataTexture?j.texSubImage2D(j.TEXTURE_2D,a,f,p,o,s,g,_,h.data):e.isCompressedTexture?j.compressedTexSubImage2D(j.TEXTURE_2D,a,f,p,h.width,h.height,g,h.data):j.texSubImage2D(j.TEXTURE_2D,a,f,p,o,s,g,_,h);M.pixelStorei(j.UNPACK_ROW_LENGTH,y),M.pixelStorei(j.UNPACK_IMAGE_HEIGHT,b),M.pixelStorei(j.UNPACK_SKIP_PIXELS,x),M.pixelStorei(j.UNPACK_SKIP_ROWS,S),M.pixelStorei(j.UNPACK_SKIP_IMAGES,C),a===0&&t.generateMipmaps===!0&&t.mipmapsAutoUpdate===!0&&j.generateMipmap(v),M.unbindTexture()},this.initRenderTarget=function(e){Me.get(e).__webglFramebuffer===void 0&&Ne.setupRenderTarget(e)},this.initTexture=function(e){e.isCubeTexture?Ne.setTextureCube(e,0):e.isData3DTexture?Ne.setTexture3D(e,0):e.isDataArrayTexture||e.isCompressedArrayTexture?Ne.setTexture2DArray(e,0):Ne.setTexture2D(e,0),M.unbindTexture()},this.resetState=function(){te=0,ne=0,re=null,M.reset(),Ye.reset()},typeof __THREE_DEVTOOLS__<`u`&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent(`observe`,{detail:this}))}get coordinateSystem(){return mm}get outputColorSpace(){return this._outputColorSpace}set outputColorSpace(e){this._outputColorSpace=e;let t=this.getContext();t.drawingBufferColorSpace=uh._getDrawingBufferColorSpace(e),t.unpackColorSpace=uh._getUnpackColorSpace()}};function _w(e,t,n,r){if(t===`hole`){let{pitch:t,first:[r,i]}=n.table.holes;return[r+t*Math.round((e.point[0]-r)/t),i+t*Math.round((e.point[1]-i)/t),0]}let i=n.components.find(t=>t.index===e.part),a=i&&r(i.index);return t===`optical`&&i?.optical&&a?new Q(...i.optical).applyMatrix4(a).toArray():e.point}function vw(e,t){let[n,r,i]=[t[0]-e[0],t[1]-e[1],t[2]-e[2]];return{x:n,y:r,z:i,whole:Math.hypot(n,r,i)}}var yw=U(`<i></i>`),bw=U(`<option> </option>`),xw=U(`<div class="clock svelte-1flhro6" role="group" aria-label="Replay: arrow keys go step by step"><button class="small" aria-label="Step back">‹</button> <button class="main small play svelte-1flhro6"> </button> <button class="small" aria-label="Step on">›</button> <span class="slide svelte-1flhro6"><input type="range" min="0" step="any" aria-label="Time of the run" class="svelte-1flhro6"/> <span class="marks svelte-1flhro6" aria-hidden="true"></span></span> <span class="number time svelte-1flhro6"> </span> <label><span class="hidden">Speed</span> <select class="small svelte-1flhro6"></select></label> <button class="small share svelte-1flhro6">Share</button> <span class="what cut svelte-1flhro6" role="status"> </span></div>`);function Sw(e,t){Ve(t,!0);let n=N(()=>Ua.frames),r=N(()=>ba(V(n),Ua.time)),i=N(()=>V(r).map(e=>{let t=e.robot?xa(V(n),e.robot,Ua.time):``;return`${e.primitive} ${e.address}${t?` (${t})`:``}`}).join(`, `)),a=e=>`${V(n).seconds?100*e/V(n).seconds:0}%`;function o(e){let t=e.target;if(t.matches(`select`))return;let r={ArrowRight:()=>e.shiftKey?Ua.seek(Ua.time+.1):Ua.step(1),ArrowLeft:()=>e.shiftKey?Ua.seek(Ua.time-.1):Ua.step(-1),Home:()=>Ua.seek(0),End:()=>Ua.seek(V(n).seconds),Escape:()=>Ua.close()};e.key===` `&&!t.matches(`button`)&&(r[` `]=()=>Ua.toggle());let i=r[e.key];i&&(e.preventDefault(),e.stopPropagation(),i())}async function s(){Ua.seek(Ua.time),await navigator.clipboard.writeText(location.href),oa.say(`Copied: whoever may look at this bench sees this moment at that address.`)}var c=xw(),l=I(c),u=z(l,2);$e(u,!0);var d=R(u,!0),f=z(u,2),p=z(f,2),m=I(p);Ei(m);var h=z(m,2);q(h,21,()=>V(n).steps,Gr,(e,t)=>{var n=yw();let r,i;B((e,a)=>{r=fi(n,1,oi(V(t).outcome),`svelte-1flhro6`,r,{arm:V(t).robot}),i=mi(n,``,i,{left:e,width:a})},[()=>a(V(t).start),()=>a(V(t).seconds)]),W(e,n)}),A(h),A(p);var g=z(p,2),_=R(g),v=z(g,2),y=z(I(v),2);q(y,20,()=>[.5,1,2,4,10],Gr,(e,t)=>{var n=bw(),r=R(n),i={};B(()=>{G(r,`${t??``}×`),i!==(i=t)&&(n.value=(n.__value=i)??``)}),W(e,n)}),A(y),vi(y),A(v);var b=z(v,2),x=R(z(b,2),!0);A(c),B((e,t,r,a)=>{G(d,Ua.playing?`Pause`:`Play`),J(m,`max`,V(n).seconds),Di(m,Ua.time),J(m,`aria-valuetext`,`${e??``} s of ${t??``} s: ${(V(i)||`nothing`)??``}`),G(_,`${r??``} / ${a??``}`),G(x,V(i)||(Ua.time>=V(n).seconds?`the end`:`nothing moves`))},[()=>Ua.time.toFixed(1),()=>V(n).seconds.toFixed(1),()=>Ua.time.toFixed(1),()=>Co(V(n).seconds)]),H(`keydown`,c,o),H(`click`,l,()=>Ua.step(-1)),H(`click`,u,()=>Ua.toggle()),H(`click`,f,()=>Ua.step(1)),H(`input`,m,e=>{Ua.playing=!1,Ua.seek(Number(e.currentTarget.value))}),yi(y,()=>Ua.speed,e=>Ua.speed=e),H(`click`,b,s),W(e,c),He()}Sr([`keydown`,`click`,`input`]);var Cw={type:`change`},ww={type:`start`},Tw={type:`end`},Ew=new P_,Dw=new d_,Ow=Math.cos(70*th.DEG2RAD),kw=new Q,Aw=2*Math.PI,jw={NONE:-1,ROTATE:0,DOLLY:1,PAN:2,TOUCH_ROTATE:3,TOUCH_PAN:4,TOUCH_DOLLY_PAN:5,TOUCH_DOLLY_ROTATE:6},Mw=1e-6,Nw=class extends rx{constructor(e,t=null){super(e,t),this.state=jw.NONE,this.target=new Q,this.cursor=new Q,this.minDistance=0,this.maxDistance=1/0,this.minZoom=0,this.maxZoom=1/0,this.minTargetRadius=0,this.maxTargetRadius=1/0,this.minPolarAngle=0,this.maxPolarAngle=Math.PI,this.minAzimuthAngle=-1/0,this.maxAzimuthAngle=1/0,this.enableDamping=!1,this.dampingFactor=.05,this.enableZoom=!0,this.zoomSpeed=1,this.enableRotate=!0,this.rotateSpeed=1,this.keyRotateSpeed=1,this.enablePan=!0,this.panSpeed=1,this.screenSpacePanning=!0,this.keyPanSpeed=7,this.zoomToCursor=!1,this.autoRotate=!1,this.autoRotateSpeed=2,this.keys={LEFT:`ArrowLeft`,UP:`ArrowUp`,RIGHT:`ArrowRight`,BOTTOM:`ArrowDown`},this.mouseButtons={LEFT:Rf.ROTATE,MIDDLE:Rf.DOLLY,RIGHT:Rf.PAN},this.touches={ONE:zf.ROTATE,TWO:zf.DOLLY_PAN},this.target0=this.target.clone(),this.position0=this.object.position.clone(),this.zoom0=this.object.zoom,this._cursorStyle=`auto`,this._domElementKeyEvents=null,this._lastPosition=new Q,this._lastQuaternion=new nh,this._lastTargetPosition=new Q,this._quat=new nh().setFromUnitVectors(e.up,new Q(0,1,0)),this._quatInverse=this._quat.clone().invert(),this._spherical=new nx,this._sphericalDelta=new nx,this._scale=1,this._panOffset=new Q,this._rotateStart=new Z,this._rotateEnd=new Z,this._rotateDelta=new Z,this._panStart=new Z,this._panEnd=new Z,this._panDelta=new Z,this._dollyStart=new Z,this._dollyEnd=new Z,this._dollyDelta=new Z,this._dollyDirection=new Q,this._mouse=new Z,this._performCursorZoom=!1,this._pointers=[],this._pointerPositions={},this._controlActive=!1,this._onPointerMove=Fw.bind(this),this._onPointerDown=Pw.bind(this),this._onPointerUp=Iw.bind(this),this._onContextMenu=Uw.bind(this),this._onMouseWheel=zw.bind(this),this._onKeyDown=Bw.bind(this),this._onTouchStart=Vw.bind(this),this._onTouchMove=Hw.bind(this),this._onMouseDown=Lw.bind(this),this._onMouseMove=Rw.bind(this),this._interceptControlDown=Ww.bind(this),this._interceptControlUp=Gw.bind(this),this.domElement!==null&&this.connect(this.domElement),this.update()}set cursorStyle(e){this._cursorStyle=e,e===`grab`?this.domElement.style.cursor=`grab`:this.domElement.style.cursor=`auto`}get cursorStyle(){return this._cursorStyle}connect(e){super.connect(e),this.domElement.addEventListener(`pointerdown`,this._onPointerDown),this.domElement.addEventListener(`pointercancel`,this._onPointerUp),this.domElement.addEventListener(`contextmenu`,this._onContextMenu),this.domElement.addEventListener(`wheel`,this._onMouseWheel,{passive:!1}),this.domElement.ownerDocument.addEventListener(`keydown`,this._interceptControlDown,{passive:!0,capture:!0}),this.domElement.style.touchAction=`none`}disconnect(){this.state=jw.NONE,this.domElement.removeEventListener(`pointerdown`,this._onPointerDown),this.domElement.ownerDocument.removeEventListener(`pointermove`,this._onPointerMove),this.domElement.ownerDocument.removeEventListener(`pointerup`,this._onPointerUp),this.domElement.removeEventListener(`pointercancel`,this._onPointerUp),this.domElement.removeEventListener(`wheel`,this._onMouseWheel),this.domElement.removeEventListener(`contextmenu`,this._onContextMenu),this.stopListenToKeyEvents(),this.domElement.ownerDocument.removeEventListener(`keydown`,this._interceptControlDown,{capture:!0}),this.domElement.ownerDocument.removeEventListener(`keyup`,this._interceptControlUp,{capture:!0}),this._controlActive=!1,this._pointers.length=0,this._pointerPositions={},this.domElement.style.touchAction=``,this.domElement.style.cursor=`auto`}dispose(){this.disconnect()}getPolarAngle(){return this._spherical.phi}getAzimuthalAngle(){return this._spherical.theta}getDistance(){return this.object.position.distanceTo(this.target)}listenToKeyEvents(e){e.addEventListener(`keydown`,this._onKeyDown),this._domElementKeyEvents=e}stopListenToKeyEvents(){this._domElementKeyEvents!==null&&(this._domElementKeyEvents.removeEventListener(`keydown`,this._onKeyDown),this._domElementKeyEvents=null)}saveState(){this.target0.copy(this.target),this.position0.copy(this.object.position),this.zoom0=this.object.zoom}reset(){this.target.copy(this.target0),this.object.position.copy(this.position0),this.object.zoom=this.zoom0,this.object.updateProjectionMatrix(),this.dispatchEvent(Cw),this.update(),this.state=jw.NONE}pan(e,t){this._pan(e,t),this.update()}dollyIn(e){this._dollyIn(e),this.update()}dollyOut(e){this._dollyOut(e),this.update()}rotateLeft(e){this._rotateLeft(e),this.update()}rotateUp(e){this._rotateUp(e),this.update()}update(e=null){let t=this.object.position;kw.copy(t).sub(this.target),kw.applyQuaternion(this._quat),this._spherical.setFromVector3(kw),this.autoRotate&&this.state===jw.NONE&&this._rotateLeft(this._getAutoRotationAngle(e)),this.enableDamping?(this._spherical.theta+=this._sphericalDelta.theta*this.dampingFactor,this._spherical.phi+=this._sphericalDelta.phi*this.dampingFactor):(this._spherical.theta+=this._sphericalDelta.theta,this._spherical.phi+=this._sphericalDelta.phi);let n=this.minAzimuthAngle,r=this.maxAzimuthAngle;isFinite(n)&&isFinite(r)&&(n<-Math.PI?n+=Aw:n>Math.PI&&(n-=Aw),r<-Math.PI?r+=Aw:r>Math.PI&&(r-=Aw),n<=r?this._spherical.theta=Math.max(n,Math.min(r,this._spherical.theta)):this._spherical.theta=this._spherical.theta>(n+r)/2?Math.max(n,this._spherical.theta):Math.min(r,this._spherical.theta)),this._spherical.phi=Math.max(this.minPolarAngle,Math.min(this.maxPolarAngle,this._spherical.phi)),this._spherical.makeSafe(),this.enableDamping===!0?this.target.addScaledVector(this._panOffset,this.dampingFactor):this.target.add(this._panOffset),this.target.sub(this.cursor),this.target.clampLength(this.minTargetRadius,this.maxTargetRadius),this.target.add(this.cursor);let i=!1;if(this.zoomToCursor&&this._performCursorZoom||this.object.isOrthographicCamera)this._spherical.radius=this._clampDistance(this._spherical.radius);else{let e=this._spherical.radius;this._spherical.radius=this._clampDistance(this._spherical.radius*this._scale),i=e!=this._spherical.radius}if(kw.setFromSpherical(this._spherical),kw.applyQuaternion(this._quatInverse),t.copy(this.target).add(kw),this.object.lookAt(this.target),this.enableDamping===!0?(this._sphericalDelta.theta*=1-this.dampingFactor,this._sphericalDelta.phi*=1-this.dampingFactor,this._panOffset.multiplyScalar(1-this.dampingFactor)):(this._sphericalDelta.set(0,0,0),this._panOffset.set(0,0,0)),this.zoomToCursor&&this._performCursorZoom){let e=null;if(this.object.isPerspectiveCamera){let t=kw.length();e=this._clampDistance(t*this._scale);let n=t-e;this.object.position.addScaledVector(this._dollyDirection,n),this.object.updateMatrixWorld(),i=!!n}else if(this.object.isOrthographicCamera){let t=new Q(this._mouse.x,this._mouse.y,0);t.unproject(this.object);let n=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),this.object.updateProjectionMatrix(),i=n!==this.object.zoom;let r=new Q(this._mouse.x,this._mouse.y,0);r.unproject(this.object),this.object.position.sub(r).add(t),this.object.updateMatrixWorld(),e=kw.length()}else console.warn(`WARNING: OrbitControls.js encountered an unknown camera type - zoom to cursor disabled.`),this.zoomToCursor=!1;e!==null&&(this.screenSpacePanning?this.target.set(0,0,-1).transformDirection(this.object.matrix).multiplyScalar(e).add(this.object.position):(Ew.origin.copy(this.object.position),Ew.direction.set(0,0,-1).transformDirection(this.object.matrix),Math.abs(this.object.up.dot(Ew.direction))<Ow?this.object.lookAt(this.target):(Dw.setFromNormalAndCoplanarPoint(this.object.up,this.target),Ew.intersectPlane(Dw,this.target))))}else if(this.object.isOrthographicCamera){let e=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),e!==this.object.zoom&&(this.object.updateProjectionMatrix(),i=!0)}return this._scale=1,this._performCursorZoom=!1,i||this._lastPosition.distanceToSquared(this.object.position)>Mw||8*(1-this._lastQuaternion.dot(this.object.quaternion))>Mw||this._lastTargetPosition.distanceToSquared(this.target)>Mw?(this.dispatchEvent(Cw),this._lastPosition.copy(this.object.position),this._lastQuaternion.copy(this.object.quaternion),this._lastTargetPosition.copy(this.target),!0):!1}_getAutoRotationAngle(e){return e===null?Aw/60/60*this.autoRotateSpeed:Aw/60*this.autoRotateSpeed*e}_getZoomScale(e){let t=Math.abs(e*.01);return .95**(this.zoomSpeed*t)}_rotateLeft(e){this._sphericalDelta.theta-=e}_rotateUp(e){this._sphericalDelta.phi-=e}_panLeft(e,t){kw.setFromMatrixColumn(t,0),kw.multiplyScalar(-e),this._panOffset.add(kw)}_panUp(e,t){this.screenSpacePanning===!0?kw.setFromMatrixColumn(t,1):(kw.setFromMatrixColumn(t,0),kw.crossVectors(this.object.up,kw)),kw.multiplyScalar(e),this._panOffset.add(kw)}_pan(e,t){let n=this.domElement;if(this.object.isPerspectiveCamera){let r=this.object.position;kw.copy(r).sub(this.target);let i=kw.length();i*=Math.tan(this.object.fov/2*Math.PI/180),this._panLeft(2*e*i/n.clientHeight,this.object.matrix),this._panUp(2*t*i/n.clientHeight,this.object.matrix)}else this.object.isOrthographicCamera?(this._panLeft(e*(this.object.right-this.object.left)/this.object.zoom/n.clientWidth,this.object.matrix),this._panUp(t*(this.object.top-this.object.bottom)/this.object.zoom/n.clientHeight,this.object.matrix)):(console.warn(`WARNING: OrbitControls.js encountered an unknown camera type - pan disabled.`),this.enablePan=!1)}_dollyOut(e){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale/=e:(console.warn(`WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled.`),this.enableZoom=!1)}_dollyIn(e){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale*=e:(console.warn(`WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled.`),this.enableZoom=!1)}_updateZoomParameters(e,t){if(!this.zoomToCursor)return;this._performCursorZoom=!0;let n=this.domElement.getBoundingClientRect(),r=e-n.left,i=t-n.top,a=n.width,o=n.height;this._mouse.x=r/a*2-1,this._mouse.y=-(i/o)*2+1,this._dollyDirection.set(this._mouse.x,this._mouse.y,1).unproject(this.object).sub(this.object.position).normalize()}_clampDistance(e){return Math.max(this.minDistance,Math.min(this.maxDistance,e))}_handleMouseDownRotate(e){this._rotateStart.set(e.clientX,e.clientY)}_handleMouseDownDolly(e){this._updateZoomParameters(e.clientX,e.clientY),this._dollyStart.set(e.clientX,e.clientY)}_handleMouseDownPan(e){this._panStart.set(e.clientX,e.clientY)}_handleMouseMoveRotate(e){this._rotateEnd.set(e.clientX,e.clientY),this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);let t=this.domElement;this._rotateLeft(Aw*this._rotateDelta.x/t.clientHeight),this._rotateUp(Aw*this._rotateDelta.y/t.clientHeight),this._rotateStart.copy(this._rotateEnd),this.update()}_handleMouseMoveDolly(e){this._dollyEnd.set(e.clientX,e.clientY),this._dollyDelta.subVectors(this._dollyEnd,this._dollyStart),this._dollyDelta.y>0?this._dollyOut(this._getZoomScale(this._dollyDelta.y)):this._dollyDelta.y<0&&this._dollyIn(this._getZoomScale(this._dollyDelta.y)),this._dollyStart.copy(this._dollyEnd),this.zoomToCursor&&(this._performCursorZoom=!0,this._dollyDirection.set(this._mouse.x,this._mouse.y,1).unproject(this.object).sub(this.object.position).normalize()),this.update()}_handleMouseMovePan(e){this._panEnd.set(e.clientX,e.clientY),this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd),this.update()}_handleMouseWheel(e){this._updateZoomParameters(e.clientX,e.clientY),e.deltaY<0?this._dollyIn(this._getZoomScale(e.deltaY)):e.deltaY>0&&this._dollyOut(this._getZoomScale(e.deltaY)),this.update()}_handleKeyDown(e){let t=!1;switch(e.code){case this.keys.UP:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateUp(Aw*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(0,this.keyPanSpeed),t=!0;break;case this.keys.BOTTOM:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateUp(-Aw*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(0,-this.keyPanSpeed),t=!0;break;case this.keys.LEFT:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateLeft(Aw*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(this.keyPanSpeed,0),t=!0;break;case this.keys.RIGHT:e.ctrlKey||e.metaKey||e.shiftKey?this.enableRotate&&this._rotateLeft(-Aw*this.keyRotateSpeed/this.domElement.clientHeight):this.enablePan&&this._pan(-this.keyPanSpeed,0),t=!0}t&&(e.preventDefault(),this.update())}_handleTouchStartRotate(e){if(this._pointers.length===1)this._rotateStart.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),r=.5*(e.pageY+t.y);this._rotateStart.set(n,r)}}_handleTouchStartPan(e){if(this._pointers.length===1)this._panStart.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),r=.5*(e.pageY+t.y);this._panStart.set(n,r)}}_handleTouchStartDolly(e){let t=this._getSecondPointerPosition(e),n=e.pageX-t.x,r=e.pageY-t.y,i=Math.sqrt(n*n+r*r);this._dollyStart.set(0,i)}_handleTouchStartDollyPan(e){this.enableZoom&&this._handleTouchStartDolly(e),this.enablePan&&this._handleTouchStartPan(e)}_handleTouchStartDollyRotate(e){this.enableZoom&&this._handleTouchStartDolly(e),this.enableRotate&&this._handleTouchStartRotate(e)}_handleTouchMoveRotate(e){if(this._pointers.length==1)this._rotateEnd.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),r=.5*(e.pageY+t.y);this._rotateEnd.set(n,r)}this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);let t=this.domElement;this._rotateLeft(Aw*this._rotateDelta.x/t.clientHeight),this._rotateUp(Aw*this._rotateDelta.y/t.clientHeight),this._rotateStart.copy(this._rotateEnd)}_handleTouchMovePan(e){if(this._pointers.length===1)this._panEnd.set(e.pageX,e.pageY);else{let t=this._getSecondPointerPosition(e),n=.5*(e.pageX+t.x),r=.5*(e.pageY+t.y);this._panEnd.set(n,r)}this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd)}_handleTouchMoveDolly(e){let t=this._getSecondPointerPosition(e),n=e.pageX-t.x,r=e.pageY-t.y,i=Math.sqrt(n*n+r*r);this._dollyEnd.set(0,i),this._dollyDelta.set(0,(this._dollyEnd.y/this._dollyStart.y)**+this.zoomSpeed),this._dollyOut(this._dollyDelta.y),this._dollyStart.copy(this._dollyEnd);let a=(e.pageX+t.x)*.5,o=(e.pageY+t.y)*.5;this._updateZoomParameters(a,o)}_handleTouchMoveDollyPan(e){this.enableZoom&&this._handleTouchMoveDolly(e),this.enablePan&&this._handleTouchMovePan(e)}_handleTouchMoveDollyRotate(e){this.enableZoom&&this._handleTouchMoveDolly(e),this.enableRotate&&this._handleTouchMoveRotate(e)}_addPointer(e){this._pointers.push(e.pointerId)}_removePointer(e){delete this._pointerPositions[e.pointerId];for(let t=0;t<this._pointers.length;t++)if(this._pointers[t]==e.pointerId){this._pointers.splice(t,1);return}}_isTrackingPointer(e){for(let t=0;t<this._pointers.length;t++)if(this._pointers[t]==e.pointerId)return!0;return!1}_trackPointer(e){let t=this._pointerPositions[e.pointerId];t===void 0&&(t=new Z,this._pointerPositions[e.pointerId]=t),t.set(e.pageX,e.pageY)}_getSecondPointerPosition(e){let t=e.pointerId===this._pointers[0]?this._pointers[1]:this._pointers[0];return this._pointerPositions[t]}_customWheelEvent(e){let t=e.deltaMode,n={clientX:e.clientX,clientY:e.clientY,deltaY:e.deltaY};switch(t){case 1:n.deltaY*=16;break;case 2:n.deltaY*=100}return e.ctrlKey&&!this._controlActive&&(n.deltaY*=10),n}};function Pw(e){this.enabled!==!1&&(this._pointers.length===0&&(this.domElement.setPointerCapture(e.pointerId),this.domElement.ownerDocument.addEventListener(`pointermove`,this._onPointerMove),this.domElement.ownerDocument.addEventListener(`pointerup`,this._onPointerUp)),this._isTrackingPointer(e)||(this._addPointer(e),e.pointerType===`touch`?this._onTouchStart(e):this._onMouseDown(e),this._cursorStyle===`grab`&&(this.domElement.style.cursor=`grabbing`)))}function Fw(e){this.enabled!==!1&&(e.pointerType===`touch`?this._onTouchMove(e):this._onMouseMove(e))}function Iw(e){switch(this._removePointer(e),this._pointers.length){case 0:this.domElement.releasePointerCapture(e.pointerId),this.domElement.ownerDocument.removeEventListener(`pointermove`,this._onPointerMove),this.domElement.ownerDocument.removeEventListener(`pointerup`,this._onPointerUp),this.dispatchEvent(Tw),this.state=jw.NONE,this._cursorStyle===`grab`&&(this.domElement.style.cursor=`grab`);break;case 1:let t=this._pointers[0],n=this._pointerPositions[t];this._onTouchStart({pointerId:t,pageX:n.x,pageY:n.y})}}function Lw(e){let t;switch(e.button){case 0:t=this.mouseButtons.LEFT;break;case 1:t=this.mouseButtons.MIDDLE;break;case 2:t=this.mouseButtons.RIGHT;break;default:t=-1}switch(t){case Rf.DOLLY:if(this.enableZoom===!1)return;this._handleMouseDownDolly(e),this.state=jw.DOLLY;break;case Rf.ROTATE:if(e.ctrlKey||e.metaKey||e.shiftKey){if(this.enablePan===!1)return;this._handleMouseDownPan(e),this.state=jw.PAN}else{if(this.enableRotate===!1)return;this._handleMouseDownRotate(e),this.state=jw.ROTATE}break;case Rf.PAN:if(e.ctrlKey||e.metaKey||e.shiftKey){if(this.enableRotate===!1)return;this._handleMouseDownRotate(e),this.state=jw.ROTATE}else{if(this.enablePan===!1)return;this._handleMouseDownPan(e),this.state=jw.PAN}break;default:this.state=jw.NONE}this.state!==jw.NONE&&this.dispatchEvent(ww)}function Rw(e){switch(this.state){case jw.ROTATE:if(this.enableRotate===!1)return;this._handleMouseMoveRotate(e);break;case jw.DOLLY:if(this.enableZoom===!1)return;this._handleMouseMoveDolly(e);break;case jw.PAN:if(this.enablePan===!1)return;this._handleMouseMovePan(e)}}function zw(e){this.enabled!==!1&&this.enableZoom!==!1&&this.state===jw.NONE&&(e.preventDefault(),this.dispatchEvent(ww),this._handleMouseWheel(this._customWheelEvent(e)),this.dispatchEvent(Tw))}function Bw(e){this.enabled!==!1&&this._handleKeyDown(e)}function Vw(e){switch(this._trackPointer(e),this._pointers.length){case 1:switch(this.touches.ONE){case zf.ROTATE:if(this.enableRotate===!1){this.state=jw.NONE;break}this._handleTouchStartRotate(e),this.state=jw.TOUCH_ROTATE;break;case zf.PAN:if(this.enablePan===!1){this.state=jw.NONE;break}this._handleTouchStartPan(e),this.state=jw.TOUCH_PAN;break;default:this.state=jw.NONE}break;case 2:switch(this.touches.TWO){case zf.DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchStartDollyPan(e),this.state=jw.TOUCH_DOLLY_PAN;break;case zf.DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchStartDollyRotate(e),this.state=jw.TOUCH_DOLLY_ROTATE;break;default:this.state=jw.NONE}break;default:this.state=jw.NONE}this.state!==jw.NONE&&this.dispatchEvent(ww)}function Hw(e){switch(this._trackPointer(e),this.state){case jw.TOUCH_ROTATE:if(this.enableRotate===!1)return;this._handleTouchMoveRotate(e),this.update();break;case jw.TOUCH_PAN:if(this.enablePan===!1)return;this._handleTouchMovePan(e),this.update();break;case jw.TOUCH_DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchMoveDollyPan(e),this.update();break;case jw.TOUCH_DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchMoveDollyRotate(e),this.update();break;default:this.state=jw.NONE}}function Uw(e){this.enabled!==!1&&e.preventDefault()}function Ww(e){e.key===`Control`&&(this._controlActive=!0,this.domElement.ownerDocument.addEventListener(`keyup`,this._interceptControlUp,{passive:!0,capture:!0}))}function Gw(e){e.key===`Control`&&(this._controlActive=!1,this.domElement.ownerDocument.removeEventListener(`keyup`,this._interceptControlUp,{passive:!0,capture:!0}))}var Kw=new Map,qw=new Q(0,1,0);function Jw([e,t,n,r=1]){let i=[e,t,n,r].join(),a=Kw.get(i);return a||(a=new Jy({color:new sg().setRGB(e,t,n,`srgb`),roughness:.55,metalness:.1}),r<1&&Object.assign(a,{transparent:!0,opacity:Math.max(r,.3),depthWrite:!1}),Kw.set(i,a)),a}function Yw(e,t,[n,r,i,a]){e.position.set(...t),e.quaternion.set(r,i,a,n)}function Xw(e,t){let n=new q_(e,Jw(t));return n.castShadow=n.receiveShadow=!0,n}function Zw(e){if(e.shape===`box`){let t=Xw(new vv(...e.size),e.color);return t.position.set(...e.at),t}let t=new Q(...e.a),n=new Q(...e.b).sub(t),r=n.length(),i=Xw(e.shape===`capsule`?new yv(e.radius,r,6,20):new bv(e.radius,e.radius,r,28),e.color);return i.position.copy(t).addScaledVector(n,.5),r>0&&i.quaternion.copy(new nh().setFromUnitVectors(qw,n.normalize())),i}function Qw(e,t){let[n=1,r=1,i=1]=e.size,a=Xw(e.shape===`box`?new vv(n,r,i):new bv(n/2,n/2,r,32).rotateX(Math.PI/2),e.color);Yw(a,e.at,e.quaternion);let o=e.rides?.at(-1);return(o===`x`||o===`y`||o===`z`)&&(a.position[o]+=t),a}function $w(e){let t=new eg;return t.name=e.name,t.add(...e.bodies.map(t=>Qw(t,t.rides&&e.stages?.[t.rides]||0))),t}function eT(e){e.traverse(e=>{e instanceof q_&&e.geometry.dispose()}),e.removeFromParent()}var tT=class{root=new eg;#e=[];constructor(e){this.root.name=e.name;let{x:t,y:n,z:r,yaw:i}=e.mount;this.root.position.set(t,n,r),this.root.rotation.z=i*Math.PI/180;let a=[];for(let t of e.links){let e=new eg;e.add(...t.shapes.map(Zw)),Yw(e,t.origin,t.quaternion),(t.parent===null?this.root:a[t.parent]).add(e),a.push(e),t.drive!==null&&t.axis&&this.#e.push({group:e,drive:t.drive,at:e.position.clone(),turned:e.quaternion.clone(),axis:new Q(...t.axis),kind:t.kind,factor:t.factor??1})}this.move(e.joints,e.width)}move(e,t){let n=new nh;for(let{group:r,drive:i,at:a,turned:o,axis:s,kind:c,factor:l}of this.#e){let u=i===`width`?t:e[i]??0;c===`slides`?r.position.copy(a).add(s.clone().multiplyScalar(u*l).applyQuaternion(o)):r.quaternion.copy(o).multiply(n.setFromAxisAngle(s,u))}}},nT={to:2068479,from:9082016,staged:14257668,bad:14696762},rT={to:1011664,from:6713725,staged:10117632,bad:12857386};function iT(e,t,n,r){let i=new eg,a=$w(t);a.name=``;let o=new F_({color:nT[e.tone],transparent:!0,opacity:.34,depthWrite:!1});if(a.traverse(e=>{e instanceof q_&&(e.material=o,e.castShadow=!1)}),a.position.set(e.x,e.y,t.position?.[2]??0),a.rotation.z=e.yaw*Math.PI/180,i.add(a),e.label){let t=e.label.length>3?oT(e.label,rT[e.tone]):aT(e.label,rT[e.tone]);t.position.set(e.x,e.y,r),i.add(t)}if(n){let t=new dv(new r_().setFromPoints([new Q(...n,4),new Q(e.x,e.y,4)]),new Zy({color:nT[e.tone],dashSize:12,gapSize:8}));t.computeLineDistances(),i.add(t)}return i}function aT(e,t){let n=document.createElement(`canvas`);n.width=n.height=64;let r=n.getContext(`2d`);r.fillStyle=`#${new sg(t).getHexString()}`,r.beginPath(),r.arc(32,32,30,0,7),r.fill(),r.fillStyle=`#fff`,r.font=`600 ${e.length>2?24:34}px system-ui, sans-serif`,r.textAlign=`center`,r.textBaseline=`middle`,r.fillText(e,32,34);let i=new O_(new m_({map:sT(n),depthTest:!1,sizeAttenuation:!1,toneMapped:!1}));return i.scale.setScalar(.03),i.renderOrder=10,i}function oT(e,t){let n=document.createElement(`canvas`),r=n.getContext(`2d`),i=`600 34px system-ui, sans-serif`;r.font=i,n.width=Math.ceil(r.measureText(e).width)+32,n.height=56,r.fillStyle=`#${new sg(t).getHexString()}`,r.beginPath(),r.roundRect(0,0,n.width,n.height,14),r.fill(),Object.assign(r,{fillStyle:`#fff`,font:i,textAlign:`center`,textBaseline:`middle`}),r.fillText(e,n.width/2,30);let a=new O_(new m_({map:sT(n),depthTest:!1,sizeAttenuation:!1,toneMapped:!1}));return a.scale.set(.026*n.width/n.height,.026,1),a.renderOrder=11,a}function sT(e){let t=new mv(e);return t.colorSpace=cm,t}function cT(e,t){let{box:n}=e.footprint??{},[r,i]=n??[60,60],a=e=>(n?fT(r+e,i+e):lT(30+e/2)).map(([e,t])=>new Z(e,t)),o=new Zv(a(18));o.holes.push(new Xv(a(6)));let s=new q_(new Iy(o),new F_({color:t,toneMapped:!1,transparent:!0,depthTest:!1,side:2}));return s.renderOrder=9,s}function lT(e,t=64){return Array.from({length:t},(n,r)=>{let i=2*Math.PI*r/t;return[e*Math.cos(i),e*Math.sin(i)]})}function uT(e,t){let n=new Q(...e.start),r=new Q(...e.end).sub(n),i=r.length(),a=t>0?Math.max(e.power/t,0):0,[o,s,c]=e.color,l=new F_({color:new sg().setRGB(o,s,c,`srgb`),transparent:!0,opacity:e.lit?e.ghost?.3:.4+.55*a:.22,depthWrite:!1}),u=new q_(new bv(1,1,i,10,1,!0).scale(.9+1.2*a,1,.9+1.2*a),l);return u.position.copy(n).addScaledVector(r,.5),u.quaternion.copy(new nh().setFromUnitVectors(new Q(0,1,0),r.normalize())),u}function dT(e,t,n=0){let r=new eg,i=[...e,e[0]].map(([e,t])=>new Q(e,t,.8));if(r.add(new dv(new r_().setFromPoints(i),new rv({color:t,transparent:!0,opacity:.8}))),n){let i=new Zv(e.map(([e,t])=>new Q(e,t,0))),a=new F_({color:t,transparent:!0,opacity:n,side:2,depthWrite:!1}),o=new q_(new Iy(i),a);o.position.z=.5,r.add(o)}return r}function fT(e,t){let n=e/2,r=t/2;return[[-n,-r],[n,-r],[n,r],[-n,r]]}function pT({x:e,y:t}){return[[e[0],t[0]],[e[1],t[0]],[e[1],t[1]],[e[0],t[1]]]}function mT(e){let t=Math.cos(e.yaw*Math.PI/180),n=Math.sin(e.yaw*Math.PI/180);return fT(64,64).map(([r,i])=>[e.x+r*t-i*n,e.y+r*n+i*t])}var hT=new F_({color:2068479,transparent:!0,opacity:.3,depthWrite:!1}),gT=new F_({color:2068479,transparent:!0,opacity:.5,depthWrite:!1}),_T=class{root=new eg;#e=new Map;#t=new Map;#n=0;show(e,t){if(e.epoch!==this.#n&&this.clear(),this.#n=e.epoch,this.root.visible=t!==null,t){for(let n of t.arms){let t=e.arms.find(e=>e.index===n.index);t&&!this.#e.has(n.index)&&this.#e.set(n.index,this.#r(new tT(t))),this.#e.get(n.index)?.move(n.joints,n.gripper)}for(let e of this.#t.values())e.visible=!1;for(let n of t.bodies){let t=e.components.find(e=>e.index===n.index);if(!t)continue;let r=this.#t.get(n.index);r||(r=$w(t),this.#t.set(n.index,r),this.root.add(vT(r,gT))),r.visible=!0,Yw(r,n.position,n.quaternion)}}}clear(){for(let e of[...this.root.children])eT(e);this.#e.clear(),this.#t.clear()}#r(e){return this.root.add(vT(e.root,hT)),e}};function vT(e,t){return e.name=``,e.traverse(e=>{e instanceof q_&&Object.assign(e,{material:t,castShadow:!1,receiveShadow:!1})}),e}var yT=2068479,bT=14696762,xT=120,ST=620,CT=class{canvas;told;slow;#e;#t=new lg;#n=new jb(38,1,10,12e3);#r;#i;#a=new Map;#o=new Map;#s=new _T;#c;#l=null;#u=!0;#d=0;#f=0;#p=null;#m=[];#h=!1;#g=null;#_={aspect:1,zoom:1};#v=null;#y=null;drag=null;#b=!1;constructor(e,t,n=!1){this.canvas=e,this.told=t,this.slow=n,this.#e=new gw({canvas:e,antialias:!n,alpha:!0,powerPreference:n?`low-power`:`default`}),this.#e.outputColorSpace=cm,this.#e.toneMapping=4,this.#e.toneMappingExposure=1.15,this.#e.shadowMap.enabled=!n,this.#e.setPixelRatio(n?1:Math.min(devicePixelRatio,2)),this.#n.up.set(0,0,1),this.#r=new Nw(this.#n,e),this.#r.maxPolarAngle=Math.PI/2-.02,this.#r.addEventListener(`change`,()=>this.#u=!0),this.#r.addEventListener(`start`,()=>this.#g=null),this.#r.addEventListener(`end`,()=>this.#z(this.#n.zoom));let r=[`table`,`slots`,`reach`,`parts`,`arms`,`beams`,`ghosts`,`phantom`,`marks`,`ruler`];this.#i=Object.fromEntries(r.map(e=>[e,new eg])),this.#t.add(...Object.values(this.#i)),this.#i.reach.visible=!1,this.#i.phantom.add(this.#s.root),this.#D(),e.addEventListener(`pointermove`,this.#F),e.addEventListener(`pointerdown`,this.#P,{capture:!0}),e.addEventListener(`pointerup`,this.#I),e.addEventListener(`pointercancel`,this.#I),e.addEventListener(`pointerleave`,()=>this.told.hover(null)),this.#c=new ResizeObserver(()=>this.#R()),this.#c.observe(e.parentElement??e),this.#f=requestAnimationFrame(this.#B)}close(){cancelAnimationFrame(this.#f),this.#c.disconnect(),this.#r.dispose(),eT(this.#t),this.#e.dispose()}show(e){let t=this.#l;this.#l=e,t?.epoch===e.epoch?t.components!==e.components&&this.#S(e,t):this.#x(e,t),this.#w(e),this.#k()}#x(e,t){for(let e of[`table`,`slots`,`reach`,`parts`,`arms`])this.#E(e);this.#a.clear(),this.#o.clear(),this.#O(e);for(let t of e.components)this.#C(t);for(let t of e.arms){let e=new tT(t);this.#o.set(t.index,e),this.#i.arms.add(e.root);for(let e of t.reach??[])this.#i.reach.add(dT(lT(e).map(([e,n])=>[e+t.mount.x,n+t.mount.y]),yT))}JSON.stringify(t?.table.size)!==JSON.stringify(e.table.size)&&this.view(`iso`)}#S(e,t){for(let n of e.components){let e=t.components.find(e=>e.index===n.index),r=this.#a.get(n.index);if(r&&(r.visible=n.position!==null),e&&r&&JSON.stringify(e.stages)===JSON.stringify(n.stages))continue;let i=this.#C(n);r&&(i.position.copy(r.position),i.quaternion.copy(r.quaternion),eT(r))}}#C(e){let t=$w(e);return t.userData.part=e.index,e.position&&e.quaternion&&Yw(t,e.position,e.quaternion),t.visible=e.position!==null,this.#a.set(e.index,t),this.#i.parts.add(t),t}#w(e){this.#E(`beams`);let t=Math.max(0,...e.beams.map(e=>e.power));for(let n of e.beams)this.#i.beams.add(uT(n,t));this.#u=!0}move(e){for(let t of e.arms)this.#o.get(t.index)?.move(t.joints,t.gripper);for(let t of e.bodies){let e=this.#a.get(t.index);e&&(Yw(e,t.position,t.quaternion),e.visible=!0)}(e.arms.length||e.bodies.length)&&(this.#k(),this.#u=!0)}ghosts(e){this.#E(`ghosts`);for(let t of e){let e=this.#T(t.part);if(!e)continue;let n=this.#a.get(t.part).position;this.#i.ghosts.add(iT(t,e,t.tone===`from`?null:[n.x,n.y],(this.#l?.table.beam_height??70)*2))}this.#u=!0}select(e,t=[]){this.#p=e,this.#m=t,this.#k(),this.#u=!0}phantom(e){this.#l&&this.#s.show(this.#l,e),this.#u=!0}layer(e,t){this.#i[e].visible=t,e===`ghosts`&&(this.#i.phantom.visible=t),this.#u=!0}view(e){let[t,n]=this.#l?.table.size??[1200,750],r=[0,t].flatMap(e=>[0,n].flatMap(t=>[-60,0].map(n=>new Q(e,t,n))));if(e!==`top`)for(let{mount:e}of this.#l?.arms??[])r.push(new Q(e.x,e.y,ST));let i={iso:[-.45,-1,.85],top:[0,-.001,1],front:[0,-1,.12],side:[1,-.05,.25]}[e];this.#h=!1,this.#g=e,this.#A(r,new Q(...i).normalize())}frame(e,t=!1){let n=this.#a.get(e);if(!n)return;this.#h=t,this.#g=null;let r=this.#n.position.clone().sub(this.#r.target).normalize();this.#j(n.position.clone().setZ(60),r,190)}ruler(e){this.#v=e?{snap:e,from:null}:null,this.#E(`ruler`),this.told.measured(null),this.#u=!0}at(e){let t=this.#a.get(e);if(!t)return null;let{left:n,top:r,width:i,height:a}=this.canvas.getBoundingClientRect(),o=t.position.clone().setZ(t.position.z+30).project(this.#n);return[n+(o.x+1)/2*i,r+(1-o.y)/2*a]}#T(e){return this.#l?.components.find(t=>t.index===e)}#E(e){for(let t of[...this.#i[e].children])eT(t)}#D(){let e=new Pb(16777215,2.1);e.position.set(-300,-500,1400),e.target.position.set(600,380,0),e.castShadow=!0,e.shadow.mapSize.set(2048,2048),Object.assign(e.shadow.camera,{left:-900,right:900,top:900,bottom:-900,near:100,far:3e3}),this.#t.add(e,e.target,new yb(16777215,8950944,1.5),new Fb(16777215,.3))}#O({table:e}){let[t,n]=e.size,r=new q_(new vv(t,n,e.thickness),new Jy({color:4870746,roughness:.8}));r.position.set(t/2,n/2,-e.thickness/2-.5);let i=new q_(new Fy(t,n),new Jy({map:wT(e.holes.pitch,e.holes.first,t,n),roughness:.7,metalness:.25}));i.position.set(t/2,n/2,0),i.receiveShadow=!0,this.#i.table.add(r,i);for(let t of e.slots)this.#i.slots.add(dT(mT(t),12109007));for(let t of e.regions)this.#i.slots.add(dT(pT(t.area),7317724,.06));for(let t of e.keep_out)this.#i.slots.add(dT(pT(t.area),bT,.14))}#k(){this.#E(`marks`);let e=this.#m.map(e=>[e,bT]);this.#p!==null&&e.push([this.#p,yT]);for(let[t,n]of e){let e=this.#T(t),r=this.#a.get(t);if(!e||!r)continue;let i=cT(e,n);i.position.set(r.position.x,r.position.y,2),i.rotation.z=2*Math.atan2(r.quaternion.z,r.quaternion.w),this.#i.marks.add(i),this.#h&&t===this.#p&&this.#r.target.copy(r.position).setZ(60)}}#A(e,t){this.#z(1);let n=e.reduce((e,t)=>e.add(t),new Q).divideScalar(e.length),r=new Q().crossVectors(this.#n.up,t).normalize(),i=new Q().crossVectors(t,r),a=Math.tan(this.#n.fov*Math.PI/360),o=a*this.#n.aspect,s=0;for(let c=0;c<4;c++){let[c,l,u,d]=[1/0,-1/0,1/0,-1/0];s=Math.max(...e.map(e=>{let s=e.clone().sub(n);return s.dot(t)+Math.max(Math.abs(s.dot(r))/o,Math.abs(s.dot(i))/a)}));for(let a of e){let e=a.clone().sub(n),o=s-e.dot(t);c=Math.min(c,e.dot(r)/o),l=Math.max(l,e.dot(r)/o),u=Math.min(u,e.dot(i)/o),d=Math.max(d,e.dot(i)/o)}n.addScaledVector(r,(c+l)/2*s).addScaledVector(i,(u+d)/2*s)}this.#r.target.copy(n),this.#n.position.copy(n).addScaledVector(t,s*1.06),this.#r.update(),this.#n.updateMatrixWorld(),this.#u=!0}#j(e,t,n){this.#z(1);let r=this.#n.fov*Math.PI/360,i=n/Math.tan(r)/Math.min(1,this.#n.aspect)*1.02;this.#r.target.copy(e),this.#n.position.copy(e).addScaledVector(t,i),this.#r.update(),this.#n.updateMatrixWorld(),this.#u=!0}#M(e){let{left:t,top:n,width:r,height:i}=this.canvas.getBoundingClientRect(),a=new Z((e.clientX-t)/r*2-1,1-(e.clientY-n)/i*2),o=new $b;o.setFromCamera(a,this.#n);let[s]=o.intersectObjects([this.#i.parts,this.#i.arms,this.#i.table].filter(e=>e.visible));if(!s)return null;let c=s.object;for(;c&&!c.name;)c=c.parent;return{part:c?.userData.part??null,name:c?.name??``,point:s.point.toArray()}}#N(e){let{left:t,top:n,width:r,height:i}=this.canvas.getBoundingClientRect(),a=new Z((e.clientX-t)/r*2-1,1-(e.clientY-n)/i*2),o=new $b;o.setFromCamera(a,this.#n);let{origin:s,direction:c}=o.ray;if(c.z>=-1e-6)return null;let l=-s.z/c.z;return[s.x+l*c.x,s.y+l*c.y]}#P=e=>{this.#y=[e.clientX,e.clientY];let t=this.drag;if(!t||this.#v||e.button!==0||!(t.always||e.altKey))return;let n=this.#M(e),r=this.#N(e);n?.part!=null&&r&&t.begin(n.part,r)&&(this.#b=!0,this.#r.enabled=!1,this.canvas.setPointerCapture(e.pointerId))};#F=e=>{let t=this.#b?this.#N(e):null;if(t&&this.drag?.over(t),e.buttons)return;let n=this.#M(e);this.canvas.style.cursor=this.#v?`crosshair`:n?.part==null?``:`pointer`,this.told.hover(n)};#I=e=>{let[t,n]=this.#y??[0,0];if(this.#y=null,this.#b){this.#b=!1,this.#r.enabled=!0,this.drag?.end();return}if(Math.hypot(e.clientX-t,e.clientY-n)>5)return;let r=this.#M(e);this.#v?r&&this.#l&&this.#L(_w(r,this.#v.snap,this.#l,e=>this.#a.get(e)?.matrixWorld)):this.told.pick(r)};#L(e){let t=this.#v;this.#E(`ruler`);let n=t.from?[t.from,e]:[e];for(let[e,t]of n.entries()){let n=aT(String.fromCharCode(65+e),yT);n.position.set(...t),this.#i.ruler.add(n)}if(t.from){let r=n.map(e=>new Q(...e)),i=new dv(new r_().setFromPoints(r),new rv({color:yT,depthTest:!1}));i.renderOrder=9,this.#i.ruler.add(i),this.told.measured({from:t.from,to:e}),t.from=null}else t.from=e;this.#u=!0}#R(){let{clientWidth:e,clientHeight:t}=this.canvas.parentElement??this.canvas;if(!e||!t)return;this.#e.setSize(e,t,!1);let{aspect:n,zoom:r}=this.#_;this.#n.aspect=e/t,this.#n.zoom=r*Math.min(1,this.#n.aspect/n),this.#n.updateProjectionMatrix(),this.#g&&this.view(this.#g),this.#u=!0}#z(e){this.#_={aspect:this.#n.aspect,zoom:e},this.#n.zoom=e,this.#n.updateProjectionMatrix()}#B=e=>{this.#f=requestAnimationFrame(this.#B),!this.#u||e-this.#d<(this.slow?xT:0)||(this.#u=!1,this.#d=e,this.#e.render(this.#t,this.#n))}};function wT(e,[t,n],r,i){let a=document.createElement(`canvas`);a.width=a.height=64;let o=a.getContext(`2d`);o.fillStyle=`#626b74`,o.fillRect(0,0,64,64),o.fillStyle=`#30363c`,o.beginPath(),o.arc(32,32,8,0,7),o.fill();let s=new mv(a);return s.wrapS=s.wrapT=Bf,s.repeat.set(r/e,i/e),s.offset.set(.5-t/e,.5-n/e),s.colorSpace=cm,s.anisotropy=8,s}var TT=U(`<p class="middle note warn svelte-bhzp8a"> </p>`),ET=U(`<p class="middle dim svelte-bhzp8a"> </p>`),DT=U(`<button> </button>`),OT=U(`<option> </option>`),kT=U(`<label><input type="checkbox" class="svelte-bhzp8a"/> </label>`),AT=U(`<p class="band lost svelte-bhzp8a" role="status"> </p>`),jT=U(`<span class="doubt svelte-bhzp8a"> </span>`),MT=U(`<div class="band svelte-bhzp8a" role="status"><strong>REPLAY</strong> <span class="grow svelte-bhzp8a"> <!></span> <button class="small svelte-bhzp8a">Back to live</button></div>`),NT=U(`<p class="band svelte-bhzp8a" role="status">Finding what moved in the run …</p>`),PT=U(`<section aria-label="Twin"><canvas aria-label="The bench in three dimensions" tabindex="-1" class="svelte-bhzp8a"></canvas> <!> <div class="top svelte-bhzp8a"><div class="tools svelte-bhzp8a" role="toolbar" aria-label="View"><!> <button class="small svelte-bhzp8a" title="Bring the chosen component into the middle and follow it">Follow</button> <button class="small svelte-bhzp8a" title="Drag and turn components: written into the manifest, the bench stays (or hold Alt and drag)">Edit by hand</button> <label class="hidden" for="snap">Ruler</label> <select id="snap" class="small mid svelte-bhzp8a"><option>Ruler off</option><!></select> <details><summary class="svelte-bhzp8a">Layers</summary> <div class="layers svelte-bhzp8a"></div></details></div> <!> <!></div> <!> <!> <p class="said mono svelte-bhzp8a" aria-live="polite"> </p></section>`);function FT(e,t){Ve(t,!0);let n,r=P(null),i=P(null),a=P(null),o=P(null),s=qt({beams:!0,ghosts:!0,arms:!0,slots:!0,reach:!1}),c=P(``),l=[[`iso`,`3D`],[`top`,`Top`],[`front`,`Front`],[`side`,`Side`]],u=[[`beams`,`Beam`],[`arms`,`Robot`],[`slots`,`Slots, regions`],[`reach`,`Reach`],[`ghosts`,`Ghosts`]],d=[[`optical`,`optical centres`],[`surface`,`surfaces`],[`hole`,`holes`]],f=N(()=>Ua.scene??Y.scene),p=new Df,h=0,g=0,_=e=>V(f)?.components.find(t=>t.name===e)?.index??null;Bi(()=>{let e=new URLSearchParams(location.search).has(`lowgpu`);try{F(r,new CT(n,{hover:e=>F(i,e),pick:e=>Gi.go(`inspect`,{part:e?.part==null?``:e.name}),measured:e=>F(a,e)},e))}catch{F(c,`This browser can't draw in three dimensions (WebGL is off); lists and plans work all the same.`);return}return Y.onframe=e=>{p.push(e,performance.now()),!h&&!Ua.film&&(h=requestAnimationFrame(v))},Object.assign(window,{picoAt:e=>V(r)?.at(_(e)??-1)??null}),()=>{Y.onframe=()=>void 0,cancelAnimationFrame(h),V(r)?.close()}});function v(e){h=0,Ua.film||(V(r)?.move(p.at(e)),p.over(e)||(h=requestAnimationFrame(v)))}_n(()=>{if(V(r)&&V(f)){if(V(r).show(V(f)),Ua.film===null&&g!==V(f).epoch){let{bodies:e,...t}=p.at(performance.now(),!0),n=new Set(V(f).components.filter(e=>e.position).map(e=>e.index));t.epoch===V(f).epoch&&V(r).move({...t,bodies:e.filter(e=>n.has(e.index))})}g=V(f).epoch}}),_n(()=>{V(r)&&Ua.frame&&V(r).move(Ua.frame)}),_n(()=>{V(r)?.phantom(Ua.film?null:qc.phantom)}),_n(()=>{let{run:e,t}=Gi.now.query,n=Y.name!==null;fr(()=>{n&&e&&t!==void 0?Ua.of!==e&&Ua.open(e,Number(t)||0):Ua.of&&Ua.close()})}),_n(()=>{V(r)?.ghosts(uu.ghost?[...qc.ghosts,uu.ghost]:qc.ghosts)}),_n(()=>{let e=qc.outlined.map(e=>_(e)).filter(e=>e!==null);V(r)?.select(_(Gi.now.query.part),e)}),_n(()=>{for(let[e]of u)V(r)?.layer(e,s[e])}),_n(()=>{V(r)?.ruler(V(o))});let y=N(()=>_(Gi.now.query.part)),b=N(()=>{if(V(a)){let e=vw(V(a).from,V(a).to);return`${xo(e.whole,1)} mm (ΔX ${xo(e.x,1)}, ΔY ${xo(e.y,1)}, ΔZ ${xo(e.z,1)})`}return V(o)?`Ruler: click two points`:V(i)?.name||``});var x=PT();let S;var C=I(x);Ii(C,e=>n=e,()=>n);var w=z(C,2),T=e=>{var t=TT(),n=R(t,!0);B(()=>G(n,V(c))),W(e,t)},E=e=>{var t=ET(),n=R(t,!0);B(()=>G(n,Y.line===`lost`?`The line to the bench is lost; trying again …`:`Waiting for the bench …`)),W(e,t)};K(w,e=>{V(c)?e(T):V(f)||e(E,1)});var D=z(w,2),O=I(D),ee=I(O);q(ee,17,()=>l,Gr,(e,t)=>{var n=N(()=>m(V(t),2));let i=()=>V(n)[0],a=()=>V(n)[1];var o=DT();let s;var c=R(o,!0);B(()=>{s=fi(o,1,`small svelte-bhzp8a`,null,s,{mid:i()===`front`||i()===`side`}),G(c,a())}),H(`click`,o,()=>V(r)?.view(i())),W(e,o)});var k=z(ee,2),te=z(k,2),ne=z(te,4),re=I(ne);re.value=re.__value=``,q(z(re),17,()=>d,Gr,(e,t)=>{var n=N(()=>m(V(t),2));let r=()=>V(n)[0],i=()=>V(n)[1];var a=OT(),o=R(a),s={};B(()=>{G(o,`Ruler: ${i()??``}`),s!==(s=r())&&(a.value=(a.__value=s)??``)}),W(e,a)}),A(ne);var ie;vi(ne);var ae=z(ne,2),oe=z(I(ae),2);q(oe,21,()=>u,Gr,(e,t)=>{var n=N(()=>m(V(t),2));let r=()=>V(n)[0],i=()=>V(n)[1];var a=kT(),o=I(a);Ei(o);var c=z(o);A(a),B(()=>G(c,` ${i()??``}`)),Mi(o,()=>s[r()],e=>s[r()]=e),W(e,a)}),A(oe),A(ae),A(O);var se=z(O,2),ce=e=>{var t=AT(),n=R(t);B(()=>G(n,`${Y.line===`lost`?`The line is lost`:`The bench's edge is away`}: this is the bench as it was. It is tried again by itself.`)),W(e,t)};K(se,e=>{V(f)&&!Ua.film&&(Y.line===`lost`||Y.edge===`away`)&&e(ce)});var le=z(se,2),ue=e=>{var t=MT(),n=z(I(t),2),r=I(n);q(z(r),17,()=>Ua.frames.diagnostics,Gr,(e,t)=>{var n=jT(),r=R(n,!0);B(()=>{J(n,`title`,V(t).hint??``),G(r,V(t).summary)}),W(e,n)}),A(n);var i=z(n,2);A(t),B(()=>G(r,`run ${Ua.frames.number??``}, ${Ua.frames.goal??``}: not the bench as it is now · ${Ua.frames.evidence??``}${Ua.frames.origin===`reconstructed`?`, the arm's way reconstructed`:``} `)),H(`click`,i,()=>Ua.close()),W(e,t)},de=e=>{W(e,NT())};K(le,e=>{Ua.frames?e(ue):Ua.opening&&e(de,1)}),A(D);var fe=z(D,2),pe=e=>{Sw(e,{})};K(fe,e=>{Ua.frames&&e(pe)});var me=z(fe,2),he=e=>{Lf(e,{get twin(){return V(r)}})};K(me,e=>{Ua.frames||e(he)});var ge=R(z(me,2),!0);A(x),B(()=>{S=fi(x,1,`svelte-bhzp8a`,null,S,{replayed:Ua.film}),k.disabled=V(y)===null,J(te,`aria-pressed`,uu.on),ie!==(ie=V(o)??``)&&(ne.value=(ne.__value=ie)??``,_i(ne,ie)),G(ge,V(b))}),H(`click`,k,()=>V(y)!==null&&V(r)?.frame(V(y),!0)),H(`click`,te,function(...e){uu.turn?.apply(this,e)}),H(`change`,ne,e=>F(o,e.currentTarget.value||null,!0)),W(e,x),He()}Sr([`click`,`change`]);var IT=U(`<main class="none svelte-1n46o8q"><p>No bench is enrolled at this coordinator yet, or you have no role in its lab. <code>pico edge enrol</code> connects one.</p></main>`),LT=U(`<button role="tab" aria-controls="panel" class="svelte-1n46o8q"> </button>`),RT=U(`<main class="svelte-1n46o8q"><aside><!></aside> <div class="twin svelte-1n46o8q"><!><!></div> <aside class="panel svelte-1n46o8q"><div role="tablist" aria-label="Panels" tabindex="-1" class="svelte-1n46o8q"></div> <div class="inside svelte-1n46o8q" role="tabpanel" id="panel"><!></div></aside></main>`),zT=U(`<div class="page svelte-1n46o8q"><!> <!> <!></div> <!>`,1),BT=U(`<p class="asking dim svelte-1n46o8q">Opening …</p>`),VT=U(`<p class="hint svelte-1n46o8q"> </p>`),HT=U(`<div><div class="grow"><p> </p><!></div> <button class="small bare" aria-label="Close">✕</button></div>`),UT=U(`<!> <div class="told svelte-1n46o8q" aria-live="polite"></div>`,1);function WT(e,t){Ve(t,!0);let n={inspect:nu,plan:Hu,history:Sl,runs:Vd,do:Rc},r=P(!1),i=P(!1),a=N(()=>n[Gi.now.tab]);Bi(()=>{aa.begin()}),_n(()=>{let e=Gi.now.bench;aa.state===`in`&&e&&Y.name!==e&&fr(()=>{Y.open(e),X.look(),X.history(),X.recorded(),oa.trying(()=>X.follow())})}),_n(()=>{Y.begun&&fr(()=>void oa.trying(()=>X.follow()))}),_n(()=>{Gi.now.query.part&&F(i,!1)});let o=!1;_n(()=>{let e=Y.edge===`away`;fr(()=>{o&&!e&&Promise.all([X.look(),X.recorded()]),o=e})});function s(e){if(aa.state!==`in`)return;let t=pu(e,()=>F(r,!0));t&&(e.preventDefault(),t())}function c(e){let t={ArrowRight:1,ArrowLeft:-1}[e.key];if(!t)return;e.stopPropagation();let n=Vi[(Vi.indexOf(Gi.now.tab)+t+Vi.length)%Vi.length];Gi.go(n),document.getElementById(`tab-${n}`)?.focus()}var l=UT();xr(`keydown`,Xt,s),ni(`1n46o8q`,e=>{Cn(()=>{Zt.title=`${Y.turn?`Your turn · `:X.question?`Asks · `:``}${Y.name?`${Y.name} · PICO`:`PICO`}`})});var u=L(l),d=e=>{iu(e,{})},f=e=>{var t=zT(),n=L(t),o=I(n);wf(o,{palette:()=>F(r,!0),parts:()=>F(i,!V(i))});var s=z(o,2),l=e=>{W(e,IT())},u=e=>{var t=RT(),n=I(t);let r;xu(I(n),{}),A(n);var o=z(n,2),s=I(o);FT(s,{}),oo(z(s),{}),A(o);var l=z(o,2),u=I(l);q(u,21,()=>Vi,Gr,(e,t)=>{var n=LT(),r=R(n,!0);B(e=>{J(n,`id`,`tab-${V(t)??``}`),J(n,`aria-selected`,Gi.now.tab===V(t)),J(n,`tabindex`,Gi.now.tab===V(t)?0:-1),G(r,e)},[()=>V(t)[0].toUpperCase()+V(t).slice(1)]),H(`click`,n,()=>Gi.go(V(t))),W(e,n)}),A(u);var d=z(u,2);ti(I(d),()=>V(a),(e,t)=>{t(e,{})}),A(d),A(l),A(t),B(()=>{r=fi(n,1,`parts svelte-1n46o8q`,null,r,{open:V(i)}),J(d,`aria-labelledby`,`tab-${Gi.now.tab??``}`)}),H(`keydown`,u,c),W(e,t)};K(s,e=>{aa.benches.length?e(u,-1):e(l)}),Kc(z(s,2),{}),A(n);var d=z(n,2),f=e=>{_u(e,{close:()=>F(r,!1)})};K(d,e=>{V(r)&&e(f)}),W(e,t)},p=e=>{W(e,BT())};K(u,e=>{aa.state===`out`?e(d):aa.state===`in`?e(f,1):e(p,-1)});var m=z(u,2);q(m,21,()=>oa.all,e=>e.number,(e,t)=>{var n=HT();let r;var i=I(n),a=I(i),o=R(a,!0),s=z(a),c=e=>{var n=VT(),r=R(n,!0);B(()=>G(r,V(t).hint)),W(e,n)};K(s,e=>{V(t).hint&&e(c)}),A(i);var l=z(i,2);A(n),B(()=>{r=fi(n,1,`note svelte-1n46o8q`,null,r,{bad:V(t).kind===`wrong`}),J(n,`role`,V(t).kind===`wrong`?`alert`:void 0),G(o,V(t).text)}),H(`click`,l,()=>oa.drop(V(t).number)),W(e,n)}),A(m),W(e,l),He()}Sr([`keydown`,`click`]),Rr(WT,{target:document.getElementById(`page`)});